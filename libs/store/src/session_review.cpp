#include "kith/store/session_review.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <set>
#include <span>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/folder_lock.hpp"
#include "kith/files/published_run.hpp"
#include "kith/live/world_json.hpp"
#include "kith/store/json_members.hpp"
#include "kith/store/session_study.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

Json json_of(const std::string& text, const std::string& what) {
  auto json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw Error{ErrorKind::kMismatch, what + " cannot be read"};
  return json;
}

RoomSetup setup_of(const StoredRoom& stored) {
  return room_setup(json_of(stored.setup, "the setup of room " + std::to_string(stored.number)));
}

constexpr const char* kErased = "(erased)";

// The questions that people answer in their own words; nothing if the study is not known.
std::optional<std::set<std::string>> text_questions(const StoreIdentity& identity) {
  if (identity.inputs.empty()) return std::nullopt;
  std::set<std::string> questions;
  const auto restored = restore_session_study(identity.inputs);
  for (const auto& question : restored.study->group().questions) {
    if (question.kind == GroupQuestion::Kind::kText) questions.insert(question.id);
  }
  return questions;
}

bool erase_answers(Json& body, const std::string& name, const std::optional<std::set<std::string>>& questions) {
  const auto answers = body.find(name);
  if (answers == body.end() || !answers->is_object()) return false;
  bool has_text = false;
  for (auto& [id, value] : answers->items()) {
    const bool is_own_words = !questions || questions->find(id) != questions->end();
    if (!is_own_words || !value.is_string() || value == kErased) continue;
    value = kErased;
    has_text = true;
  }
  return has_text;
}

// What identifies people, taken out of the body of an event. @return whether there was anything.
bool erase_person(const std::string& type, Json& body, const std::optional<std::set<std::string>>& questions) {
  const auto blank = [&](const std::string& name, Json empty) {
    const auto found = body.find(name);
    if (found == body.end() || *found == empty) return false;
    *found = std::move(empty);
    return true;
  };
  const auto erased = [&](const PersonalMember& member) {
    const std::string name{member.name};
    switch (member.what) {
      case PersonalMember::What::kNameIfAny:
        return body.contains(name) && body[name] != Json(std::string{}) && blank(name, kErased);
      case PersonalMember::What::kName:
      case PersonalMember::What::kWords:
        return blank(name, kErased);
      case PersonalMember::What::kQuery:
        return blank(name, Json::object());
      case PersonalMember::What::kAnswers:
        return erase_answers(body, name, questions);
    }
    return false;
  };
  if (!body.is_object()) return false;
  if (type == "turned-away") return blank("query", Json::object());  // of the service, from no room
  const auto* kind = room_event_kind(type);
  bool has_any = false;
  for (const auto& member : kind == nullptr ? std::array<PersonalMember, 2>{} : kind->personal) {
    if (!member.name.empty()) has_any = erased(member) || has_any;
  }
  return has_any;
}

// What is left of an event of or about somebody who is withdrawn. A path that the group saw in a discussion stays: what
// the others took over is one of these.
void erase_deed(const std::string& type, Json& body, const RoomEvent& event, const LiveStudy& study, const Room& room) {
  const auto is = [&](const RoomEventKind& kind) { return type == kind.word; };
  const auto* answer = event.get<happening::Answered>();
  const bool was_seen = answer != nullptr && study.group().discussion.choice.is_held();
  const auto leave = [&](StartIndex start, const auto& path) {
    if (!path.erased.is_null()) return;
    const auto judged = judged_path(*study.atlas, start, path.actions, path.for_ever);
    body["erased"] = {{"finished", judged.is_finished}, {"counts", judged.counts ? to_json(*judged.counts) : Json{}}};
  };
  if (answer != nullptr && !was_seen) leave(room.session().lesson().tests.at(answer->test).start, *answer);
  if (const auto* examined = event.get<happening::Examined>()) leave(StartIndex{examined->start}, *examined);
  if (body.contains("actions") && !was_seen) body["actions"] = Json::array();
  if (body.contains("keys")) body["keys"] = Json::array();
  if (body.contains("ms")) body["ms"] = 0;
  if (body.contains("ready_us")) body["ready_us"] = event.at_us;
  if (body.contains("screened")) body["screened"] = std::vector<bool>(body["screened"].size());
  if (is(happening::QuestionsAnswered::kKind)) body["answers"] = Json::object();
  if (is(happening::Explored::kKind)) body = {{"start", Json{}}, {"map", Json::array()}};
}

// Events of the person of these seats in one room, as they are to be. The times are just after those of what happened
// before: whoever was ready earlier stays ahead on the waiting list.
std::vector<StoredEvent> without_person(EventFile& file, const StoredRoom& stored, const std::set<StoredSeat>& seats,
                                        const std::shared_ptr<const LiveStudy>& study) {
  const auto is_theirs = [&](std::size_t seat) { return seats.count({stored.number, seat}) != 0; };
  TeachingCache cache{study->atlas};
  Room room{study, setup_of(stored), cache};
  std::vector<StoredEvent> changed;
  std::int64_t before_us = stored.created_us;
  file.for_each_event(
      [&](const StoredEvent& event) {
        auto body = body_of(event);
        auto now = event;
        const bool is_own = is_theirs(seat_of_actor(event.actor).value_or(0));
        if (is_own || is_theirs(count_at(body, "seat"))) {
          erase_person(event.type, body, std::nullopt);
          if (body.contains("reason") && event.actor == "facilitator") body["reason"] = kErased;
          erase_deed(event.type, body, room_event_of(event), *study, room);
          now.json = body.dump();
          if (is_own) now.at_us = std::min(event.at_us, before_us + 1);
          if (now != event) changed.push_back(now);
        }
        if (!is_own) before_us = event.at_us;
        try {
          room.apply(room_event_of(now), cache);
        } catch (const Error& error) {
          refuse_run(ErrorKind::kMismatch, "E1614", file.path(),
                     "nothing was erased, since room " + room.setup().id + " would not replay: " + error.what(),
                     "use the version of kith and the kind of machine that the session was run with");
        }
      },
      stored.number);
  return changed;
}

// All seats that the person of one has had: that on the waiting list, and those with the same id of the platform. Of
// room 0, the numbers of the events that they were turned away.
std::set<StoredSeat> seats_of_person(EventFile& file, const LiveStudy& study, const StoredSeat& seat) {
  std::map<std::string, std::int64_t> rooms;  // by id
  for (const auto& stored : file.rooms()) rooms.emplace(setup_of(stored).id, stored.number);
  std::map<StoredSeat, std::string> ids;
  std::vector<std::pair<StoredSeat, StoredSeat>> moves;
  file.for_each_event([&](const StoredEvent& event) {
    const auto body = body_of(event);  // of who joined, consented, was seated or turned away
    if (event.type != happening::Joined::kKind.word && !body.contains("query")) return;
    StoredSeat place{event.room, seat_of_actor(event.actor).value_or(count_at(body, "seat"))};
    if (event.room == 0) place.second = event.seq;
    ids[place] = platform_id(study, body.value("query", Json{}));
    if (!body.contains("from")) return;
    const auto found = rooms.find(text_at(body.at("from"), "room"));
    if (found != rooms.end()) moves.push_back({{found->second, count_at(body.at("from"), "seat")}, place});
  });

  std::set<StoredSeat> seats;
  if (ids.count(seat) == 0) return seats;
  for (const auto& [place, id] : ids) {
    if (place == seat || (!id.empty() && id == ids.at(seat))) seats.insert(place);
  }
  for (const auto& [from, to] : moves) {
    if (to == seat || from == seat) seats.insert({from, to});
  }
  return seats;
}

// Groups that have had all lessons that the study allows: whether the last one is over, only the rooms themselves tell.
void find_taught(EventFile& file, std::vector<RoomSummary>& rooms) {
  std::optional<SessionStudy> study;
  std::optional<TeachingCache> cache;
  for (auto& room : rooms) {
    if (!room.has_started || room.is_taught || !room.ended.empty()) continue;
    if (!study) {
      study = restore_session_study(file.identity().inputs);
      cache.emplace(study->study->atlas);
    }
    if (room.lessons < study->study->spec.teaching.max_periods) continue;
    static_cast<void>(
        replay_room(file, find_room(file, room.id), study->study, *cache, [&](const Room& now, const RoomEvent&) {
          room.is_taught = now.stage() == RoomStage::kQuestions || now.stage() == RoomStage::kEnded;
        }));
  }
}

}  // namespace

std::string platform_id(const LiveStudy& study, const Json& query) {
  const auto& names = study.group().collect_query;
  const auto id = names.empty() ? std::string{} : text_at(query, names.front().c_str());
  return id.find("{{") == std::string::npos ? id : std::string{};  // what the platform did not fill in
}

std::set<StoredSeat> withdrawn_seats(EventFile& file) {
  std::set<StoredSeat> seats;
  file.for_each_event(
      [&](const StoredEvent& event) {
        if (event.type != "redacted") return;
        for (const auto& one : body_of(event).value("withdrawn", Json::array())) {
          seats.emplace(one.at(0).get<std::int64_t>(), one.at(1).get<std::size_t>());
        }
      },
      0);
  return seats;
}

Json body_of(const StoredEvent& event) {
  return json_of(event.json, "event " + std::to_string(event.seq) + " of room " + std::to_string(event.room));
}

RoomEvent room_event_of(const StoredEvent& event) {
  return room_event(event.seq, event.at_us, event.actor, event.type, body_of(event));
}

std::vector<RoomSummary> list_rooms(EventFile& file) {
  std::vector<RoomSummary> rooms;
  for (const auto& stored : file.rooms()) {
    const auto setup = setup_of(stored);
    rooms.push_back({.number = stored.number,
                     .id = setup.id,
                     .strategy = setup.strategy,
                     .composition = setup.composition,
                     .created_us = stored.created_us});
  }

  // Both lists are in the order of rooms.
  auto at = rooms.begin();
  std::set<std::pair<std::int64_t, std::size_t>> gone;  // rooms and seats
  file.for_each_event([&](const StoredEvent& event) {
    while (at != rooms.end() && at->number < event.room) ++at;
    if (at == rooms.end() || at->number != event.room) return;
    ++at->events;
    at->last_us = event.at_us;

    const auto is = [&](const RoomEventKind& kind) { return event.type == kind.word; };
    at->joined += is(happening::Joined::kKind) || is(happening::Seated::kKind) ? 1u : 0u;
    if (is(happening::LessonChosen::kKind)) {
      const auto body = body_of(event);
      at->is_taught = body.value("finished", false);
      if (!at->is_taught) at->lessons = body.value("period", at->lessons);
    }
    if (is(happening::Left::kKind)) gone.emplace(event.room, seat_of_actor(event.actor).value_or(0));
    if (is(happening::Dropped::kKind) || is(happening::Simulated::kKind)) {
      gone.emplace(event.room, body_of(event).value("seat", std::size_t{0}));
    }
    if (is(happening::Readmitted::kKind) || is(happening::Present::kKind)) {
      gone.erase({event.room, body_of(event).value("seat", std::size_t{0})});
    }
    at->answers += is(happening::Answered::kKind) ? 1u : 0u;
    at->has_started = at->has_started || is(happening::Started::kKind);
    if (is(happening::Ended::kKind)) at->ended = body_of(event).value("reason", std::string{});
  });

  for (auto& room : rooms) {
    room.gone = static_cast<std::size_t>(
        std::count_if(gone.begin(), gone.end(), [&](const auto& one) { return one.first == room.number; }));
  }
  find_taught(file, rooms);
  return rooms;
}

StoredRoom find_room(EventFile& file, const std::string& name) {
  for (const auto& stored : file.rooms()) {
    const auto setup = setup_of(stored);
    if (setup.id == name || setup.code == name) return stored;
  }
  refuse_run(ErrorKind::kInvalidInput, "E1618", file.path(), "there is no room '" + name + "' in this session",
             "list the rooms with 'kith session list'");
}

ReplayedRoom replay_room(EventFile& file, const StoredRoom& stored, const std::shared_ptr<const LiveStudy>& study,
                         TeachingCache& cache, const std::function<void(const Room&, const RoomEvent&)>& on_event) {
  auto setup = setup_of(stored);
  ReplayedRoom replayed;
  replayed.number = stored.number;
  replayed.id = setup.id;
  std::vector<StoredEvent> events;
  file.for_each_event([&](const StoredEvent& event) { events.push_back(event); }, stored.number);
  try {
    Room room{study, std::move(setup), cache};
    for (const auto& stored_event : events) {
      const auto event = room_event_of(stored_event);
      room.apply(event, cache);
      ++replayed.events;
      const auto* chosen = event.get<happening::LessonChosen>();
      if (chosen != nullptr && !chosen->finished) replayed.lessons = chosen->period;
      if (on_event) on_event(room, event);
    }
    replayed.digest = room.digest();
  } catch (const Error& error) {
    replayed.problem = "event " + std::to_string(replayed.events + 1) + ": " + error.what();
  }
  return replayed;
}

namespace {

// A session that is about to be changed.
struct OpenSession {
  std::optional<FolderLock> lock;
  EventFile file;

  void finish(const Json& body, StoreBatch log, std::span<const StoredEvent> changed, std::int64_t now_us) {
    log.events.push_back({.room = 0,
                          .seq = file.count_events(0) + 1,
                          .at_us = now_us,
                          .actor = "admin",
                          .type = "redacted",
                          .json = body.dump()});
    file.write({&log, 1});
    file.rewrite(changed);
  }
};

OpenSession opened(const fs::path& folder, std::int64_t now_us) {
  const auto identity = EventFile::read(folder).identity();  // refuses folders without a session
  auto lock = FolderLock::try_acquire(folder);
  if (!lock) {
    refuse_run(ErrorKind::kBusy, "E1610", folder, "another process serves the sessions in this folder",
               "stop it before erasing anything");
  }
  return {std::move(lock), EventFile::open(folder, identity, now_us)};
}

}  // namespace

std::size_t redact(const fs::path& folder, std::optional<std::string> room, std::int64_t now_us) {
  auto session = opened(folder, now_us);
  std::optional<std::int64_t> number;
  if (room) number = find_room(session.file, *room).number;
  const auto questions = text_questions(session.file.identity());
  std::vector<StoredEvent> changed;
  session.file.for_each_event([&](const StoredEvent& event) {
    if (number && event.room != *number) return;
    auto body = body_of(event);
    if (!erase_person(event.type, body, questions)) return;
    changed.push_back(event);
    changed.back().json = body.dump();
  });
  session.finish({{"room", room ? Json{*room} : Json{}}, {"events", changed.size()}}, {}, changed, now_us);
  return changed.size();
}

std::map<std::string, std::size_t> withdraw(const fs::path& folder, const std::string& room, std::size_t seat,
                                            std::int64_t now_us, bool is_trial) {
  auto session = opened(folder, now_us);
  auto& file = session.file;
  const auto stored = find_room(file, room);
  const auto study = restore_session_study(file.identity().inputs).study;
  const auto seats = seats_of_person(file, *study, {stored.number, seat});
  if (seats.empty()) {
    refuse_run(ErrorKind::kInvalidInput, "E1624", folder,
               "nobody has had seat " + std::to_string(seat) + " of room '" + room + "'",
               "'kith session export' writes participants.csv, with the seats");
  }

  std::vector<StoredEvent> changed;
  std::set<std::pair<std::string, std::size_t>> links;  // rooms, by id, and seats
  StoreBatch log;
  for (const auto& one : file.rooms()) {
    const auto before = links.size();
    for (const auto& [number, whose] : seats) {
      if (number == one.number) links.emplace(setup_of(one).id, whose);
    }
    if (links.size() == before) continue;
    for (auto& event : without_person(file, one, seats, study)) changed.push_back(std::move(event));
  }
  // The log says who found no seat, and who followed their link again.
  file.for_each_event(
      [&](const StoredEvent& event) {
        const auto body = body_of(event);
        const bool has_returned =
            event.type == "returned" && links.count({text_at(body, "room"), count_at(body, "seat")}) != 0;
        if (!has_returned && seats.count({0, event.seq}) == 0) return;
        changed.push_back(event);
        changed.back().json = (has_returned ? Json{{"room", kErased}, {"seat", 0}} : Json::object()).dump();
      },
      0);
  for (const auto& token : file.tokens()) {
    const StoredSeat place{token.room, static_cast<std::size_t>(token.seat)};
    if (!token.revoked && seats.count(place) != 0) log.revoked.push_back(token.hash);
  }
  if (!is_trial) {
    session.finish({{"room", room}, {"seat", seat}, {"events", changed.size()}, {"withdrawn", seats}}, std::move(log),
                   changed, now_us);
  }
  std::map<std::string, std::size_t> counts;
  for (const auto& event : changed) ++counts[event.type];
  return counts;
}

}  // namespace kith
