// What facilitators and observers see.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kith/live/room_audit.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::int64_t kMillisecond = 1000;

// Whether a person has so many wrong answers that they may need help.
bool has_many_wrong(const Json& row) {
  constexpr std::size_t kFew = 6;  // tests
  return std::any_of(row.at("seats").begin(), row.at("seats").end(), [](const Json& seat) {
    const auto tests = seat.value("tests", std::size_t{0});
    return seat.at("kind") == "person" && tests >= kFew && 3 * seat.at("right").get<std::size_t>() < 2 * tests;
  });
}

// A room's row, who of it understands what, and for each of its seats what is not known to the room.
struct Row {
  struct Seat {
    std::optional<double> latency_ms;
    std::optional<std::string> link;
  };
  std::shared_ptr<const Json> row, people;
  std::vector<Seat> seats;
};

Json filled(const Row& from) {
  Json row = *from.row;
  auto added = from.seats.begin();
  for (auto& seat : row["seats"]) {
    if (added->latency_ms) seat["latency_ms"] = *added->latency_ms;
    if (added->link) seat["link"] = *added->link;
    ++added;
    if (!from.people) continue;
    for (const auto& person : *from.people) {
      if (person.at("seat") == seat.at("seat") && person.contains("needs_help"))
        seat["needs_help"] = person["needs_help"];
    }
  }
  return row;
}

}  // namespace

bool LiveService::State::can_show(const HostedRoom& hosted, const std::string& what,
                                  const std::function<void()>& show) {
  std::string problem;
  try {
    show();
  } catch (const std::exception& error) {
    problem = "room " + hosted.setup().code + ": the " + what + " cannot be shown: " + error.what();
  }
  const std::lock_guard lock{mutex};
  const std::pair key{hosted.number(), what};
  if (problem.empty()) {
    has_news = unseen.erase(key) > 0 || has_news;
  } else {
    has_news = std::exchange(unseen[key], problem) != problem || has_news;
  }
  return problem.empty();
}

// Remembers how a room looks, for facilitators. On its strand.
void LiveService::State::take_picture(HostedRoom& hosted) {
  const auto* room = hosted.room();
  if (room == nullptr) return;
  const auto now = now_us();
  const bool is_selected = [&] {
    const std::lock_guard lock{mutex};
    return selected.count(hosted.number()) != 0;
  }();
  RoomPicture picture;
  const auto take = [&](Viewer::Role role, auto& row, auto& detail) {
    const Viewer viewer{.role = role, .seat = 0};
    can_show(hosted, "row", [&] { row = std::make_shared<const Json>(room->row(viewer)); });
    if (!is_selected) return;
    can_show(hosted, "page", [&] { detail = std::make_shared<const Json>(room->view(viewer, now).at("room")); });
  };
  take(Viewer::Role::kFacilitator, picture.row, picture.detail);
  take(Viewer::Role::kObserver, picture.observer_row, picture.observer_detail);
  {
    const std::lock_guard lock{mutex};
    const bool is_of_interest = is_selected || (picture.row && has_many_wrong(*picture.row));
    const auto known = audits.find(hosted.number());
    const auto judged = known == audits.end() ? std::size_t{0} : known->second.periods;
    if (is_of_interest && hosted.num_observed() > judged) to_audit.insert(hosted.number());
    pictures[hosted.number()] = std::move(picture);
    has_news = true;
  }
  audit_next();
}

void LiveService::State::audit_next() {
  std::shared_ptr<HostedRoom> hosted;
  {
    const std::lock_guard lock{mutex};
    if (is_auditing || to_audit.empty() || is_stopping) return;
    auto next =
        std::find_if(to_audit.begin(), to_audit.end(), [&](auto number) { return selected.count(number) != 0; });
    if (next == to_audit.end()) next = to_audit.begin();
    const auto found = rooms.find(*next);
    to_audit.erase(next);
    if (found == rooms.end()) return;
    hosted = found->second;
    is_auditing = true;
  }
  post(hosted->number(), [this, hosted](TeachingCache&) {
    RoomAudit audit{.periods = hosted->num_observed(), .people = nullptr};
    if (hosted->room() == nullptr) {
      is_auditing = false;
      return;
    }
    // Where many wait the job may be forgotten; then the next picture asks again.
    std::shared_ptr<void> turn{nullptr, [this](void*) { is_auditing = false; }};
    teach(TeachingPool::Urgency::kAhead,
          [this, hosted, audit, turn = std::move(turn), people = hosted->observed()](TeachingCache& cache) mutable {
            can_show(*hosted, "audit", [&] {
              const auto judged = audit_room(cache, *study, hosted->setup(), std::move(people));
              audit.people = std::make_shared<const Json>(people_json(*study->atlas, judged));
            });
            turn.reset();
            keep_audit(hosted->number(), std::move(audit));
          });
  });
}

void LiveService::State::keep_audit(std::int64_t number, RoomAudit audit) {
  {
    const std::lock_guard lock{mutex};
    audits[number] = std::move(audit);
    has_news = true;
  }
  audit_next();
}

// Shows facilitators what is new. On the strand of the service.
void LiveService::State::show_facilitators() {
  std::vector<std::shared_ptr<Connection>> watchers;
  {
    const std::lock_guard lock{mutex};
    for (const auto& [id, connection] : connections) {
      if (connection->is_known && connection->identity.role != Role::kParticipant) watchers.push_back(connection);
    }
  }
  for (const auto& watcher : watchers) {
    try {
      push_view(*watcher, facilitator_view(*watcher));
    } catch (const std::exception&) {
      watcher->dismiss("no-view", kGoingAway);
    }
  }
}

Json LiveService::State::facilitator_view(const Connection& connection) const {
  const bool is_facilitator = connection.identity.role == Role::kFacilitator;
  const auto counters = integrity();
  Json view{{"v", 1},
            {"role", name_of(connection.identity.role)},
            {"server_ms", now_us() / kMillisecond},
            {"study", live_study_json(*study)}};

  // Everybody waits for the mutex: what takes time is done without it.
  std::vector<Row> rows;
  std::shared_ptr<const Json> detail;
  std::unique_lock lock{mutex};
  if (is_facilitator) {
    const auto page = [&](const char* path, const std::string& token) {
      return token.empty() ? std::string{} : base_url + path + token;
    };
    view["links"] = {{"facilitator", page("/f#t=", facilitator_token)},
                     {"observer", page("/f#t=", observer_token)},
                     {"join", base_url + "/j?code=" + join_code},
                     {"code", join_code}};
  }

  for (const auto& [number, picture] : pictures) {
    const auto& row = is_facilitator ? picture.row : picture.observer_row;
    if (!row || row->is_null()) continue;
    const auto audit = audits.find(number);
    auto& added = rows.emplace_back(Row{row, audit == audits.end() ? nullptr : audit->second.people, {}});
    for (const auto& seat : row->at("seats")) {
      auto& [latency_ms, link] = added.seats.emplace_back();
      const Place place{number, seat.at("seat").get<std::int64_t>()};
      const auto contact = contacts.find(place);
      const auto person = contact == contacts.end() ? connections.end() : connections.find(contact->second.connection);
      if (person != connections.end() && person->second->round_trip)
        latency_ms = static_cast<double>(person->second->round_trip->count()) / 1000.0;

      // Who came from the waiting list still uses the link of their place there.
      auto token = is_facilitator ? tokens->known(place.first, place.second) : std::nullopt;
      if (const auto from = came_from.find(place); is_facilitator && !token && from != came_from.end()) {
        token = tokens->known(from->second.first, from->second.second);
      }
      if (token) link = base_url + "/j#t=" + *token;
    }
  }

  const auto selected_room = pictures.find(connection.selected);
  std::shared_ptr<const Json> people;
  if (const auto audit = audits.find(connection.selected); audit != audits.end()) people = audit->second.people;
  if (selected_room != pictures.end()) {
    detail = is_facilitator ? selected_room->second.detail : selected_room->second.observer_detail;
  }

  Json lines = Json::array();
  for (const auto& entry : log) {
    Json line{{"at_ms", entry.at_us / kMillisecond}, {"actor", entry.actor}, {"what", entry.what}};
    if (!entry.room.empty()) line["room"] = entry.room;
    if (is_facilitator && !entry.reason.empty()) line["reason"] = entry.reason;
    lines.push_back(std::move(line));
  }
  lock.unlock();

  view["rooms"] = Json::array();
  for (const auto& row : rows) view["rooms"].push_back(filled(row));
  if (detail && !detail->is_null()) {
    view["room"] = *detail;
    if (people) view["room"]["people"] = *people;
  }
  view["log"] = std::move(lines);
  view["integrity"] = counters;
  return view;
}

Json LiveService::State::integrity() const {
  const auto counters = store->counters();
  const std::lock_guard lock{mutex};
  std::size_t unsaved = counters.waiting;
  for (const auto& [number, room] : rooms) unsaved += room->is_unsaved() ? 1u : 0u;
  Json problems = Json::array();
  if (!counters.problem.empty()) problems.push_back("The last event could not be saved: " + counters.problem);
  if (free_space < kLittleSpace)
    problems.push_back("Only " + std::to_string(free_space / 1'000'000) + " MB are free on the disk" +
                       (free_space < kNoSpace ? ": nobody new is let in." : "."));
  for (const auto& [room, what] : troubles) problems.push_back(what);
  for (const auto& [view, what] : unseen) problems.push_back(what);
  return {{"events", counters.events + unsaved},
          {"stored", counters.events},
          {"unsaved", unsaved},
          {"free_mb", free_space / 1'000'000},
          {"last_commit_ms", counters.last_commit_us / kMillisecond},
          {"problems", problems}};
}

}  // namespace kith
