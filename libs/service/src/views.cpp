#include "views.hpp"

#include <algorithm>
#include <utility>

#include "kith/live/room_audit.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::int64_t kMillisecond = 1000;
constexpr std::size_t kLogLength = 200;
constexpr std::size_t kRoomsPerTick = 50;  // that facilitators are shown
constexpr std::size_t kTicksAwaited = 2;   // what there is, and the picture that is taken meanwhile

// Whether a person has so many wrong answers that they may need help.
bool has_many_wrong(const Json& row) {
  constexpr std::size_t kFew = 6;  // tests
  return std::any_of(row.at("seats").begin(), row.at("seats").end(), [](const Json& seat) {
    const auto tests = seat.value("tests", std::size_t{0});
    return seat.at("kind") == "person" && tests >= kFew && 3 * seat.at("right").get<std::size_t>() < 2 * tests;
  });
}

// The row with what is not known to the room.
Json filled(const WatchedRoom& from, bool is_facilitator) {
  Json row = is_facilitator ? *from.row : *from.observer_row;
  auto added = from.seats.begin();
  for (auto& seat : row["seats"]) {
    if (added->latency_ms) seat["latency_ms"] = *added->latency_ms;
    if (added->link && is_facilitator) seat["link"] = *added->link;
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

Views::Views(ServiceState& service) : service_{service}, strand_{service.strands.make()} {}

void Views::post(Strands::Job job) { service_.strands.post(strand_, std::move(job)); }

void Views::watch(const ConnectionPtr& connection) {
  post([this, connection] {
    watchers_[connection->id] = {.connection = connection, .room = nullptr, .ticks_awaited = kTicksAwaited};
  });
}

void Views::select(const ConnectionPtr& connection, const std::shared_ptr<HostedRoom>& room) {
  post([this, connection, room] {
    const auto found = watchers_.find(connection->id);
    if (found == watchers_.end()) return;
    if (room) ++room->num_watchers;
    const auto former = std::exchange(found->second.room, room);
    if (former) --former->num_watchers;
    if (room) changed_[room->number()] = room;
    found->second.ticks_awaited = kTicksAwaited;
  });
}

void Views::leave(const ConnectionPtr& connection) {
  post([this, connection] {
    const auto watcher = watchers_.extract(connection->id);
    if (!watcher.empty() && watcher.mapped().room) --watcher.mapped().room->num_watchers;
  });
}

void Views::changed(const std::shared_ptr<HostedRoom>& room) {
  post([this, room] { changed_[room->number()] = room; });
}

void Views::write(LogEntry entry) {
  post([this, entry = std::move(entry)] {
    log_.push_back(entry);
    if (log_.size() > kLogLength) log_.pop_front();
    has_news_ = true;
  });
}

void Views::news() {
  post([this] { has_news_ = true; });
}

void Views::trouble(std::int64_t room, const std::string& what) {
  post([this, room, what] {
    troubles_[room] = what;
    has_news_ = true;
  });
}

void Views::unseen(const HostedRoom& room, const std::string& what, const std::string& problem) {
  post([this, &room, what, problem] { note_unseen(room, what, problem); });
}

void Views::note_unseen(const HostedRoom& room, const std::string& what, const std::string& problem) {
  const std::pair key{room.number(), what};
  const auto text = "room " + room.setup().code + ": the " + what + " cannot be shown: " + problem;
  const bool is_new = problem.empty() ? unseen_.erase(key) > 0 : std::exchange(unseen_[key], text) != text;
  has_news_ = has_news_ || is_new;
}

void Views::tick() {
  post([this] {
    if (watchers_.empty()) return;
    const auto changed = std::exchange(changed_, {});
    for (const auto& [number, room] : changed) take_picture(room);
    if (pictures_.empty() && !changed.empty()) return;  // the first page has its rooms

    // The list of many rooms is large, and something happens in one of them all the time: whoever waits for something
    // else is shown that alone.
    const bool is_due = ++ticks_since_shown_ > pictures_.size() / kRoomsPerTick && std::exchange(has_news_, false);
    if (is_due) ticks_since_shown_ = 0;
    std::vector<std::pair<Watcher, bool>> to;
    for (auto& [id, watcher] : watchers_) {
      if (!is_due && watcher.ticks_awaited == 0) continue;
      watcher.ticks_awaited -= std::min<std::size_t>(watcher.ticks_awaited, 1);
      to.emplace_back(watcher, !std::exchange(watcher.has_rooms, true) || is_due);
    }
    if (!to.empty()) show(to);
  });
}

// Remembers how a room looks.
void Views::take_picture(const std::shared_ptr<HostedRoom>& hosted) {
  hosted->post([this, hosted] {
    const auto* room = hosted->room();
    if (room == nullptr) return;
    const auto now = service_.now_us();
    Picture picture;
    const Viewer facilitator{.role = Viewer::Role::kFacilitator, .seat = 0};
    const Viewer observer{.role = Viewer::Role::kObserver, .seat = 0};
    hosted->can_show("row", [&] {
      picture.row = std::make_shared<const Json>(room->row(facilitator));
      picture.observer_row = std::make_shared<const Json>(room->row(observer));
    });
    if (hosted->num_watchers > 0) {
      hosted->can_show("page",
                       [&] { picture.detail = std::make_shared<const Json>(room->view(observer, now).at("room")); });
    }
    post([this, hosted, picture = std::move(picture), num_observed = hosted->num_observed()] {
      keep_picture(hosted, picture, num_observed);
    });
  });
}

// Has who understands what computed anew where somebody looks, or where somebody has many wrong answers: there only
// when there is a third more to judge by, since it takes the longer the more there is.
void Views::keep_picture(const std::shared_ptr<HostedRoom>& hosted, Picture picture, std::size_t num_observed) {
  const auto known = audits_.find(hosted->number());
  const auto judged = known == audits_.end() ? std::size_t{0} : known->second.periods;
  const bool is_watched = hosted->num_watchers > 0;
  const bool is_of_interest = is_watched || (picture.row && has_many_wrong(*picture.row));
  if (is_of_interest && num_observed > judged + (is_watched ? 0 : judged / 3)) to_audit_[hosted->number()] = hosted;
  pictures_[hosted->number()] = std::move(picture);
  has_news_ = true;
  audit_next();
}

void Views::audit_next() {
  if (is_auditing_ || to_audit_.empty() || service_.is_stopping) return;
  auto next =
      std::find_if(to_audit_.begin(), to_audit_.end(), [](const auto& room) { return room.second->num_watchers > 0; });
  if (next == to_audit_.end()) next = to_audit_.begin();
  const auto hosted = next->second;
  to_audit_.erase(next);
  is_auditing_ = true;
  // Where many lessons wait this may be forgotten; then the next picture asks again.
  const auto give_up = [this, number = ++num_audits_](void*) {
    post([this, number] { is_auditing_ = is_auditing_ && number != num_audits_; });
  };
  const std::shared_ptr<void> turn{nullptr, give_up};
  hosted->post([this, hosted, turn] {
    if (hosted->room() != nullptr) judge(hosted, turn);
  });
}

// On the strand of the room.
void Views::judge(const std::shared_ptr<HostedRoom>& hosted, const std::shared_ptr<void>& turn) {
  service_.teachers.post(TeachingPool::Urgency::kAhead,
                         [this, hosted, turn, audit = Audit{.periods = hosted->num_observed(), .people = {}},
                          people = hosted->observed()](TeachingCache& cache) mutable {
                           std::string problem;
                           try {
                             const auto judged = audit_room(cache, *service_.study, hosted->setup(), std::move(people));
                             audit.people = std::make_shared<const Json>(people_json(*service_.study->atlas, judged));
                           } catch (const std::exception& error) {
                             problem = error.what();
                           }
                           post([this, hosted, audit, problem] { keep_audit(*hosted, audit, problem); });
                         });
}

void Views::keep_audit(const HostedRoom& hosted, Audit audit, const std::string& problem) {
  note_unseen(hosted, "audit", problem);
  audits_[hosted.number()] = std::move(audit);
  has_news_ = true;
  is_auditing_ = false;
  audit_next();
}

std::vector<WatchedRoom> Views::watched_rooms() const {
  std::vector<WatchedRoom> watched;
  for (const auto& [number, picture] : pictures_) {
    if (!picture.row || !picture.observer_row) continue;
    const auto audit = audits_.find(number);
    auto& room = watched.emplace_back(WatchedRoom{.number = number,
                                                  .row = picture.row,
                                                  .observer_row = picture.observer_row,
                                                  .people = audit == audits_.end() ? nullptr : audit->second.people,
                                                  .seats = {}});
    for (const auto& seat : room.row->at("seats")) room.seats.push_back({.number = seat.at("seat")});
  }
  return watched;
}

void Views::show(const std::vector<std::pair<Watcher, bool>>& to_with_rooms) {
  WatchedRooms watched;
  if (std::ranges::any_of(to_with_rooms, &std::pair<Watcher, bool>::second)) watched.rooms = watched_rooms();
  service_.post([this, to_with_rooms, watched = std::move(watched)]() mutable {
    service_.directory.fill(watched);
    post([this, to_with_rooms, watched = std::move(watched)] {
      for (const auto& [watcher, with_rooms] : to_with_rooms) {
        try {
          watcher.connection->show(view_of(watcher, watched, with_rooms));
        } catch (const std::exception&) {
          watcher.connection->dismiss("no-view", kGoingAway);
        }
      }
    });
  });
}

Json Views::view_of(const Watcher& watcher, const WatchedRooms& watched, bool with_rooms) const {
  const auto role = watcher.connection->identity.role;
  const bool is_facilitator = role == Role::kFacilitator;
  Json view{{"v", 1},
            {"role", name_of(role)},
            {"server_ms", service_.now_us() / kMillisecond},
            {"study", live_study_json(*service_.study)},
            {"log", Json::array()},
            {"integrity", integrity_of(watched.num_unsaved)}};
  if (is_facilitator) view["links"] = watched.links;
  if (with_rooms) {
    auto& rooms = view["rooms"] = Json::array();
    for (const auto& room : watched.rooms) rooms.push_back(filled(room, is_facilitator));
  }

  const auto number = watcher.room ? watcher.room->number() : 0;
  const auto picture = pictures_.find(number);
  if (picture != pictures_.end() && picture->second.detail) {
    view["room"] = *picture->second.detail;
    const auto audit = audits_.find(number);
    if (audit != audits_.end() && audit->second.people) view["room"]["people"] = *audit->second.people;
  }

  for (const auto& entry : log_) {
    Json line{{"at_ms", entry.at_us / kMillisecond}, {"actor", entry.actor}, {"what", entry.what}};
    if (!entry.room.empty()) line["room"] = entry.room;
    if (is_facilitator && !entry.reason.empty()) line["reason"] = entry.reason;
    view["log"].push_back(std::move(line));
  }
  return view;
}

void Views::integrity(std::size_t num_unsaved, std::function<void(Json)> done) {
  post([this, num_unsaved, done = std::move(done)] { done(integrity_of(num_unsaved)); });
}

Json Views::integrity_of(std::size_t num_unsaved) const {
  const auto counters = service_.store.counters();
  const auto unsaved = counters.waiting + num_unsaved;
  const std::uint64_t free_space = service_.free_space;
  Json problems = Json::array();
  if (!counters.problem.empty()) problems.push_back("The last event could not be saved: " + counters.problem);
  if (free_space < kLittleSpace)
    problems.push_back("Only " + std::to_string(free_space / 1'000'000) + " MB are free on the disk" +
                       (free_space < kNoSpace ? ": nobody new is let in." : "."));
  for (const auto& [room, what] : troubles_) problems.push_back(what);
  for (const auto& [view, what] : unseen_) problems.push_back(what);
  return {{"events", counters.events + unsaved},
          {"stored", counters.events},
          {"unsaved", unsaved},
          {"free_mb", free_space / 1'000'000},
          {"last_commit_ms", counters.last_commit_us / kMillisecond},
          {"problems", problems}};
}

}  // namespace kith
