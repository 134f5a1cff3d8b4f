// Requests below /api.
#include <algorithm>
#include <chrono>
#include <future>
#include <optional>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/live/world_json.hpp"
#include "kith/store/random_token.hpp"
#include "kith/store/session_export.hpp"
#include "qr_svg.hpp"
#include "service_state.hpp"
#include "tar.hpp"

namespace kith {
namespace {

using HttpReply = LiveService::HttpReply;

constexpr std::chrono::seconds kLongestWait{5};  // for the disk
constexpr std::size_t kLongestQrText = 1000;

HttpReply json_reply(int status, const Json& body) {
  return {.status = status, .body = body.dump() + "\n", .headers = {{"Cache-Control", "no-store"}}};
}

HttpReply error_reply(int status, const std::string& reason, const std::string& text) {
  return json_reply(status, {{"error", reason}, {"text", text}});
}

std::optional<unsigned> digit_of(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A' + 10);
  return std::nullopt;
}

// The value of a parameter in a query such as "a=1&b=2"; empty if it is not there.
std::string parameter(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const auto end = std::min(query.find('&'), query.size());
    const auto pair = query.substr(0, end);
    query.remove_prefix(std::min(end + 1, query.size()));
    const auto equals = std::min(pair.find('='), pair.size());
    if (pair.substr(0, equals) != name) continue;
    std::string value;
    const auto text = pair.substr(std::min(equals + 1, pair.size()));
    for (std::size_t i = 0; i < text.size(); ++i) {
      const auto high = i + 2 < text.size() && text[i] == '%' ? digit_of(text[i + 1]) : std::nullopt;
      const auto low = high ? digit_of(text[i + 2]) : std::nullopt;
      if (low) {
        value += static_cast<char>(*high * 16 + *low);
        i += 2;
      } else {
        value += text[i] == '+' ? ' ' : text[i];
      }
    }
    return value;
  }
  return {};
}

// Waits for an answer that another thread gives; nothing if it takes too long.
template <typename T>
std::optional<T> wait_for(std::future<T> answer) {
  if (answer.wait_for(kLongestWait) != std::future_status::ready) return std::nullopt;
  return answer.get();
}

// Drops what is more than a minute old.
void forget_old(std::map<std::string, std::deque<std::int64_t>>& times, std::int64_t now) {
  for (auto at = times.begin(); at != times.end();) {
    auto& moments = at->second;
    while (!moments.empty() && now - moments.front() > 60 * kSecond) moments.pop_front();
    at = moments.empty() ? times.erase(at) : std::next(at);
  }
}

}  // namespace

LiveService::HttpReply LiveService::http(const HttpRequest& request) {
  try {
    return state_->handle(request);
  } catch (const std::exception&) {
    return error_reply(500, "internal", "An unexpected error occurred on the server.");
  }
}

LiveService::HttpReply LiveService::State::handle(const HttpRequest& request) {
  const auto mark = std::min(request.target.find('?'), request.target.size());
  auto path = request.target.substr(0, mark);
  const auto query = request.target.substr(std::min(mark + 1, request.target.size()));
  constexpr std::string_view kWorlds = "/api/world/";
  std::string key;
  if (path.compare(0, kWorlds.size(), kWorlds) == 0) {
    key = path.substr(kWorlds.size());
    path = "/api/world";
  }

  const auto route = request.method + " " + path;
  const auto known = permissions();
  if (std::none_of(known.begin(), known.end(), [&](const Permission& permission) { return permission.name == route; }))
    return error_reply(404, "not-found", "There is no such page.");

  Identity identity;
  {
    const std::lock_guard lock{mutex};
    if (is_stopping) return error_reply(503, "stopping", "The server is stopping.");
    if (!request.bearer.empty()) identity = tokens->identify(request.bearer, now_us());
  }
  if (!is_allowed(route, identity.role)) {
    const int status = identity.role == Role::kNobody ? 401 : 403;
    return error_reply(status, "not-allowed", "This link does not allow that.");
  }

  if (route == "GET /api/health") return json_reply(200, {{"status", "ok"}, {"server", options.program}});
  if (route == "POST /api/join") return join(request);
  if (route == "GET /api/texts") return json_reply(200, language_json(*study));
  if (route == "GET /api/world") return world(key);
  if (route == "GET /api/integrity") return json_reply(200, integrity());
  if (route == "GET /api/export") return export_tables(query);

  // What is left is GET /api/qr.
  const auto text = parameter(query, "text");
  const auto picture = text.size() <= kLongestQrText ? qr_svg(text) : std::nullopt;
  if (!picture) return error_reply(400, "bad-text", "A QR code needs a text of 1 to 1000 bytes.");
  return {.status = 200, .content_type = "image/svg+xml", .body = *picture, .headers = {{"Cache-Control", "no-store"}}};
}

LiveService::HttpReply LiveService::State::world(const std::string& key) {
  std::shared_ptr<const std::string> text;
  {
    const std::lock_guard lock{mutex};
    const auto found = worlds.find(key);
    if (found != worlds.end()) text = found->second;
  }
  if (!text) {
    const auto number = world_of_key(*study, key);
    if (!number) return error_reply(404, "not-found", "There is no such world.");
    text = std::make_shared<const std::string>(world_json(*study, *number).dump());
    const std::lock_guard lock{mutex};
    worlds.emplace(key, text);
  }
  return {.status = 200, .body = *text, .headers = {{"Cache-Control", "private, max-age=31536000, immutable"}}};
}

LiveService::HttpReply LiveService::State::join(const HttpRequest& request) {
  const auto body = request.body.size() <= 65536 ? Json::parse(request.body, nullptr, false) : Json{};
  if (!body.is_object()) return error_reply(400, "bad-body", "The request must be a JSON object.");
  const auto code = body.find("code");
  if (code == body.end() || !code->is_string()) return error_reply(400, "bad-body", "The request needs a code.");
  const auto query = collected_query(*study, body.value("query", Json{}));
  const auto person = person_of(*study, query);
  {
    const std::lock_guard lock{mutex};
    const auto now = now_us();
    forget_old(joins, now);
    forget_old(wrong_codes, now);
    const auto count = [&](const auto& times) {
      const auto found = times.find(request.remote);
      return found == times.end() ? std::size_t{0} : found->second.size();
    };
    const bool is_too_many = options.joins_per_minute > 0 && count(joins) >= options.joins_per_minute;
    // The code of the study is too long to be guessed: a room full of people can always use it.
    const bool is_guessing = *code != join_code && options.wrong_codes_per_minute > 0 &&
                             count(wrong_codes) >= options.wrong_codes_per_minute;
    if (is_guessing)
      return error_reply(429, "too-many", "Too many wrong codes came from this address; try again in a minute.");
    if (is_too_many)
      return error_reply(429, "too-many", "Too many people joined from this address; try again in a minute.");
    joins[request.remote].push_back(now);
    if (free_space < kNoSpace) return error_reply(503, "no-space", "Nobody new can join at the moment.");
  }
  std::unique_lock one_at_a_time{joining};
  std::vector<std::shared_ptr<HostedRoom>> open;
  bool is_study = false;
  bool is_known = false;  // that it is the code of a room
  {
    const std::lock_guard lock{mutex};
    is_study = *code == join_code;
    for (const auto& [number, room] : rooms) {
      const bool is_own = room->setup().code == *code;
      is_known = is_known || is_own;
      // Who comes to be screened is not given a seat beforehand.
      const bool is_for_all = is_study && (waiting_list == 0 || number == waiting_list);
      if ((is_for_all || is_own) && room->may_have_free_seat()) open.push_back(room);
    }
  }
  if (!is_known && !is_study) {
    const std::lock_guard lock{mutex};
    wrong_codes[request.remote].push_back(now_us());
    return error_reply(404, "no-room", "There is no group with this code.");
  }

  // Whoever is asked in a browser that has joined before says so, unless the link itself tells people apart.
  if (person.empty() && body.value("has_joined", Json{}) == true) return json_reply(200, {{"ask", true}});

  const auto take_seat = [&](const std::shared_ptr<HostedRoom>& room) {
    auto promise = std::make_shared<std::promise<std::int64_t>>();  // the seat, 0: none is free
    auto seat = promise->get_future();
    post(room->number(), [room, promise](TeachingCache&) {
      if (room->room() != nullptr && !room->room()->has_free_seat()) return promise->set_value(0);
      room->ask({.actor = "server", .type = "join", .body = Json::object(), .id = {}},
                [promise](const CommandOutcome& outcome) {
                  std::int64_t taken = 0;
                  for (const auto& event : outcome.events) {
                    const auto* came = event.get<happening::Joined>();
                    if (came != nullptr) taken = static_cast<std::int64_t>(came->seat);
                  }
                  promise->set_value(taken);
                });
    });
    return wait_for(std::move(seat));
  };
  const auto give_link = [&](const std::shared_ptr<HostedRoom>& room, std::int64_t seat, bool is_new = true) {
    // Links that were made for the seat beforehand are void: two people must not share it.
    std::vector<std::string> former;
    {
      const std::lock_guard lock{mutex};
      const Place place{room->number(), seat};
      if (is_new) former = tokens->of_seat(room->number(), seat);  // else the older tab hears that another one is open
      if (is_new && !query.empty()) queries[place] = query;
      if (is_new && !person.empty()) seat_of_person[person] = place;
    }
    one_at_a_time.unlock();
    auto promise = std::make_shared<std::promise<std::string>>();
    auto token = promise->get_future();
    make_link(room->number(), seat, [promise](const std::string& made) { promise->set_value(made); });
    const auto made = wait_for(std::move(token));
    if (!made || made->empty()) return error_reply(503, "not-saved", "The server could not save this; try again.");
    StoreBatch batch;
    batch.revoked = former;
    {
      const std::lock_guard lock{mutex};
      for (const auto& hash : former) tokens->revoke(hash);
    }
    if (!former.empty()) save(std::move(batch), [](bool) {});
    return json_reply(200, {{"token", *made}});
  };

  // Who follows the link again comes back to their seat, wherever that is now.
  std::shared_ptr<HostedRoom> former_room;
  Place former_seat{};
  if (!person.empty()) {
    const std::lock_guard lock{mutex};
    if (const auto known = seat_of_person.find(person); known != seat_of_person.end()) {
      former_seat = place_of({.role = Role::kParticipant, .room = known->second.first, .seat = known->second.second});
      if (const auto found = rooms.find(former_seat.first); found != rooms.end()) former_room = found->second;
    }
  }
  if (former_room) {
    record({}, "server", "returned", {{"room", room_id(former_seat.first)}, {"seat", former_seat.second}}, {},
           [](bool) {});
    return give_link(former_room, former_seat.second, false);
  }

  for (const auto& room : open) {
    const auto seat = take_seat(room);
    if (!seat) return error_reply(503, "not-saved", "The server could not save this; try again.");
    if (*seat > 0) return give_link(room, *seat);
  }
  if (is_study && waiting_list == 0) {
    auto promise = std::make_shared<std::promise<RoomsMade>>();
    auto answer = promise->get_future();
    post(0, [this, promise](TeachingCache&) {
      make_rooms(Json::object(), "server", {}, [promise](const RoomsMade& made) { promise->set_value(made); });
    });
    const auto made = wait_for(std::move(answer));
    if (!made) return error_reply(503, "not-saved", "The server could not save this; try again.");
    if (!made->refusal) {
      const auto room = room_of(made->rooms.front());
      const auto seat = take_seat(room);
      if (seat && *seat > 0) return give_link(room, *seat);
    }
  }
  one_at_a_time.unlock();
  // Nobody must be able to guess such a code, and whoever pays has to find it in the log.
  const bool pays = study->group().completion.pay_full;
  const auto paid = pays ? completion_code(*study, random_token(), "full", 0) : std::string{};
  record({}, "server", "turned-away", {{"code", paid}, {"query", query}}, {}, [](bool) {});
  const auto page = full_view(*study, paid, query, now_us());
  return json_reply(200, {{"full", page}});
}

LiveService::HttpReply LiveService::State::export_tables(const std::string& query) {
  SessionExportOptions what;
  const auto name = parameter(query, "room");
  if (!name.empty()) {
    const auto room = room_named(name);
    if (!room) return error_reply(404, "no-room", "There is no such room.");
    what.room = room->number();
  }
  try {
    auto file = EventFile::read(options.folder);
    std::map<std::string, std::string> files;
    TeachingCache cache{study->atlas};
    export_session(file, study, cache, what,
                   [&](std::string_view table, std::string_view piece) { files[std::string{table}] += piece; });
    return {.status = 200,
            .content_type = "application/x-tar",
            .body = tar_of(files, now_us() / kSecond),
            .headers = {{"Content-Disposition", "attachment; filename=\"kith-session.tar\""},
                        {"Cache-Control", "no-store"}}};
  } catch (const std::exception& error) {
    return error_reply(500, "export", error.what());
  }
}

}  // namespace kith
