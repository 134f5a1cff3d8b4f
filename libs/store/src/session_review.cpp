#include "kith/store/session_review.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <set>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/folder_lock.hpp"
#include "kith/files/published_run.hpp"
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

}  // namespace

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
    RoomSummary room;
    room.number = stored.number;
    room.id = setup.id;
    room.strategy = setup.strategy;
    room.composition = setup.composition;
    room.created_us = stored.created_us;
    rooms.push_back(std::move(room));
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

std::size_t redact(const fs::path& folder, std::optional<std::string> room, std::int64_t now_us) {
  static_cast<void>(EventFile::read(folder));  // refuses folders without a session
  const auto lock = FolderLock::try_acquire(folder);
  if (!lock) {
    refuse_run(ErrorKind::kBusy, "E1610", folder, "another process serves the sessions in this folder",
               "stop it before erasing anything");
  }
  const auto identity = EventFile::read(folder).identity();
  auto file = EventFile::open(folder, identity, now_us);
  std::optional<std::int64_t> number;
  if (room) number = find_room(file, *room).number;
  const auto questions = text_questions(identity);
  std::vector<StoredEvent> changed;
  std::uint64_t service_seq = 0;
  file.for_each_event([&](const StoredEvent& event) {
    if (event.room == 0) service_seq = event.seq;
    if (number && event.room != *number) return;
    auto body = body_of(event);
    if (!erase_person(event.type, body, questions)) return;
    changed.push_back(event);
    changed.back().json = body.dump();
  });
  StoreBatch log;
  log.events.push_back({.room = 0,
                        .seq = service_seq + 1,
                        .at_us = now_us,
                        .actor = "admin",
                        .type = "redacted",
                        .json = Json{{"room", room ? Json{*room} : Json{}}, {"events", changed.size()}}.dump()});
  file.write({&log, 1});
  file.rewrite(changed);
  return changed.size();
}

}  // namespace kith
