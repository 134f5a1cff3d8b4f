#include "join_desk.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "kith/store/json_members.hpp"
#include "kith/store/random_token.hpp"
#include "kith/store/session_review.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::chrono::seconds kLongestWait{5};  // for the disk

// Drops what is more than a minute old.
void forget_old(std::map<std::string, std::deque<std::int64_t>>& times, std::int64_t now) {
  for (auto at = times.begin(); at != times.end();) {
    auto& moments = at->second;
    while (!moments.empty() && now - moments.front() > 60 * kSecond) moments.pop_front();
    at = moments.empty() ? times.erase(at) : std::next(at);
  }
}

std::int64_t seat_taken(const CommandOutcome& outcome) {
  for (const auto& event : outcome.events) {
    if (const auto* joined = event.get<happening::Joined>()) return static_cast<std::int64_t>(joined->seat);
  }
  return 0;
}

}  // namespace

struct JoinDesk::Visit {
  std::string remote, code, person;
  Json query;
  bool is_of_study = false;  // by its link, not that of a room
  bool may_make = false;     // a room, if none is free
  bool has_turn = false;
  bool is_over = false;
  std::deque<std::shared_ptr<HostedRoom>> open{};
  HttpAnswer answer;
  asio::steady_timer deadline;
};

void JoinDesk::join(const LiveService::HttpRequest& request, const HttpAnswer& answer) {
  const auto body = request.body.size() <= 65536 ? Json::parse(request.body, nullptr, false) : Json{};
  if (!body.is_object()) return answer(error_reply(400, "bad-body", "The request must be a JSON object."));
  const auto code = text_at(body, "code");
  if (!body.contains("code") || !body["code"].is_string())
    return answer(error_reply(400, "bad-body", "The request needs a code."));
  const auto query = collected_query(*service_.study, body.value("query", Json{}));
  const bool is_of_study = code == service_.join_code;
  const auto visit = std::make_shared<Visit>(Visit{.remote = request.remote,
                                                   .code = code,
                                                   .person = platform_id(*service_.study, query),
                                                   .query = query,
                                                   .is_of_study = is_of_study,
                                                   .may_make = is_of_study && service_.directory.waiting_list() == 0,
                                                   .answer = answer,
                                                   .deadline = asio::steady_timer{service_.desk}});
  if (const auto refusal = refusal_for(*visit)) return answer(*refusal);

  // Whoever is asked in a browser that has joined before says so, unless the link itself tells people apart.
  if (visit->person.empty() && body.value("has_joined", Json{}) == true)
    return answer(json_reply(200, {{"ask", true}}));
  turns_.take([this, visit] { guarded(visit, [&] { find_seat(visit); }); });
}

std::optional<LiveService::HttpReply> JoinDesk::refusal_for(const Visit& visit) {
  const auto now = service_.now_us();
  const auto& options = service_.options;
  forget_old(joins_, now);
  forget_old(wrong_codes_, now);
  const auto is_beyond = [&](const auto& times, std::size_t most) {
    const auto found = times.find(visit.remote);
    return most > 0 && found != times.end() && found->second.size() >= most;
  };

  // The code of the study is too long to be guessed: a room full of people can always use it.
  if (!visit.is_of_study && is_beyond(wrong_codes_, options.wrong_codes_per_minute))
    return error_reply(429, "too-many", "Too many wrong codes came from this address; try again in a minute.");
  if (is_beyond(joins_, options.joins_per_minute))
    return error_reply(429, "too-many", "Too many people joined from this address; try again in a minute.");
  joins_[visit.remote].push_back(now);
  if (service_.free_space < kNoSpace) return error_reply(503, "no-space", "Nobody new can join at the moment.");

  const auto& rooms = service_.directory.rooms();
  const bool is_known = visit.is_of_study || std::any_of(rooms.begin(), rooms.end(), [&](const auto& room) {
                          return room.second->setup().code == visit.code;
                        });
  if (is_known) return std::nullopt;
  wrong_codes_[visit.remote].push_back(now);
  return error_reply(404, "no-room", "There is no group with this code.");
}

// Whatever goes wrong in a step, whoever waits gets an answer, and the next one a turn.
template <typename Step>
void JoinDesk::guarded(const VisitPtr& visit, const Step& step) {
  try {
    step();
  } catch (const std::exception&) {
    finish(visit, error_reply(500, "internal", "An unexpected error occurred on the server."));
  }
}

void JoinDesk::find_seat(const VisitPtr& visit) {
  visit->has_turn = true;
  visit->deadline.expires_after(kLongestWait);
  visit->deadline.async_wait([this, visit](NetError error) {
    if (!error) finish(visit, error_reply(503, "not-saved", "The server could not save this; try again."));
  });

  // Who follows the link again comes back to their seat, wherever that is now.
  if (const auto place = service_.directory.seat_of(visit->person)) {
    const Json where{{"room", room_id(place->first)}, {"seat", place->second}};
    service_.log.record({}, "server", "returned", where);
    return give_link(visit, *place, false);
  }

  const auto list = service_.directory.waiting_list();
  for (const auto& [number, room] : service_.directory.rooms()) {
    // Who comes to be screened is not given a seat beforehand.
    const bool is_for_all = visit->is_of_study && (list == 0 || number == list);
    const bool is_for_them = is_for_all || room->setup().code == visit->code;
    if (is_for_them && room->may_have_free_seat()) visit->open.push_back(room);
  }
  try_next(visit);
}

void JoinDesk::try_next(const VisitPtr& visit) {
  if (visit->is_over) return;
  if (visit->open.empty()) return std::exchange(visit->may_make, false) ? make_room(visit) : turn_away(visit);
  const auto room = std::move(visit->open.front());
  visit->open.pop_front();
  take_seat(visit, room);
}

void JoinDesk::take_seat(const VisitPtr& visit, const std::shared_ptr<HostedRoom>& room) {
  const auto done = [this, visit, room](std::int64_t seat) {
    service_.post([this, visit, room, seat] {
      if (visit->is_over) return;
      guarded(visit, [&] { seat == 0 ? try_next(visit) : give_link(visit, {room->number(), seat}, true); });
    });
  };
  room->post([room, done] {
    if (room->room() != nullptr && !room->room()->has_free_seat()) return done(0);
    room->ask({.actor = "server", .type = "join", .body = Json::object(), .id = {}},
              [done](const CommandOutcome& outcome) { done(seat_taken(outcome)); });
  });
}

void JoinDesk::make_room(const VisitPtr& visit) {
  service_.maker.make(Json::object(), "server", {}, [this, visit](const RoomMaker::Made& made) {
    visit->open.assign(made.rooms.begin(), made.rooms.end());
    guarded(visit, [&] { try_next(visit); });
  });
}

void JoinDesk::give_link(const VisitPtr& visit, const Place& place, bool is_new) {
  auto& directory = service_.directory;
  if (is_new) directory.seat(place, visit->person, visit->query);
  end_turn(*visit);

  // Links that were made for the seat beforehand are void: two people must not share it. Of somebody who is back the
  // older tab hears that another one is open.
  directory.make_link(place, is_new, [this, visit](const std::string& token) {
    if (token.empty())
      return finish(visit, error_reply(503, "not-saved", "The server could not save this; try again."));
    finish(visit, json_reply(200, {{"token", token}}));
  });
}

void JoinDesk::turn_away(const VisitPtr& visit) {
  const auto& study = *service_.study;
  // Nobody must be able to guess such a code, and whoever pays has to find it in the log.
  const bool pays = study.group().completion.pay_full;
  const auto paid = pays ? completion_code(study, random_token(), "full", 0) : std::string{};
  service_.log.record({}, "server", "turned-away", {{"code", paid}, {"query", visit->query}});
  finish(visit, json_reply(200, {{"full", full_view(study, paid, visit->query, service_.now_us())}}));
}

void JoinDesk::finish(const VisitPtr& visit, const LiveService::HttpReply& reply) {
  if (std::exchange(visit->is_over, true)) return;
  visit->deadline.cancel();
  end_turn(*visit);
  visit->answer(reply);
}

void JoinDesk::end_turn(Visit& visit) {
  if (std::exchange(visit.has_turn, false)) turns_.end();
}

}  // namespace kith
