#include "kith/service/lesson_log.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "hosted_room.hpp"
#include "kith/core/error.hpp"
#include "kith/files/folder_lock.hpp"
#include "kith/files/published_run.hpp"
#include "kith/live/lesson_log.hpp"
#include "kith/live/room.hpp"
#include "kith/store/event_file.hpp"

namespace kith {
namespace {

constexpr const char* kFileSchema = "kith.lesson/1";
constexpr const char* kLogSchema = "kith.lesson-log/1";
constexpr std::size_t kMostBytes = 64'000'000;  // of a log

struct LessonLog {
  std::map<std::string, std::string> inputs;
  RoomSetup setup;
  std::vector<RoomEvent> events;
  std::map<std::uint64_t, Json> lessons;  // lesson_content() by number of the event
  std::string study;
  std::string seal;
};

[[noreturn]] void refuse_log(const std::string& name, const std::string& why) {
  refuse_run(ErrorKind::kInvalidInput, "E1621", name, why,
             "ask the person to save the answers again, with the button in the lesson");
}

[[noreturn]] void refuse_change(const std::string& name, const std::string& why) {
  refuse_run(ErrorKind::kMismatch, "E1622", name, "the log is not what the lesson recorded: " + why,
             "it was edited, or its lesson was made by another version of kith: import it with that version");
}

LessonLog parsed_log(std::string_view text, const std::string& name) {
  if (text.size() > kMostBytes) refuse_log(name, "the file is larger than any log");
  try {
    const Json json = Json::parse(text);
    if (!json.is_object() || json.value("schema", "") != kLogSchema) {
      refuse_log(name, "this is not the log of a lesson file");
    }
    LessonLog log;
    log.inputs = json.at("inputs").get<std::map<std::string, std::string>>();
    log.setup = room_setup(json.at("setup"));
    for (const auto& event : json.at("events")) log.events.push_back(room_event(event));
    log.study = json.at("study").get<std::string>();
    for (const auto& lesson : json.at("lessons")) {
      const bool is_new = log.lessons.try_emplace(lesson.at("seq").get<std::uint64_t>(), lesson).second;
      if (!is_new) refuse_log(name, "the log has a lesson twice");
    }
    log.seal = json.at("seal").get<std::string>();
    return log;
  } catch (const Json::parse_error& error) {
    refuse_log(name, "the file was cut off or changed: it is no JSON from byte " + std::to_string(error.byte) + " on");
  } catch (const Json::exception& error) {
    refuse_log(name, std::string{"the log lacks a part, or has one of another kind ("} + error.what() + ")");
  } catch (const Error& error) {
    if (!error.diagnostics().empty() && error.diagnostics().front().id == "E1621") throw;
    refuse_log(name, std::string{"the log has an event that cannot be read: "} + error.what());
  }
}

// The lesson that this kith chooses where the log has one. They are compared by what they show and ask.
TaughtLesson same_lesson(const LessonLog& log, const RoomEvent& event, const Room& room, TeachingCache& cache,
                         const std::string& name) {
  const auto task = room.teaching();
  if (!task) refuse_change(name, "event " + std::to_string(event.seq) + ": no lesson is chosen here");
  auto lesson = task->run(cache);
  const auto known = log.lessons.find(event.seq);
  if (known == log.lessons.end() || known->second != lesson_content(lesson, event.seq)) {
    refuse_change(name, "event " + std::to_string(event.seq) + ": the teacher chooses another lesson");
  }
  return lesson;
}

// The events as they happen here.
std::vector<RoomEvent> replayed(const LessonLog& log, const SessionStudy& session, const std::string& name) {
  if (session.digest != log.study) refuse_change(name, "its study is not the one that it names");
  std::string seal;
  for (const auto& event : log.events) seal = sealed(seal, event);
  if (seal != log.seal) refuse_change(name, "its seal is not that of its events");

  TeachingCache cache{session.study->atlas};
  std::vector<RoomEvent> events;
  std::uint64_t at = 0;
  std::size_t num_lessons = 0;
  try {
    Room room{session.study, log.setup, cache};
    for (const auto& event : log.events) {
      at = event.seq;

      // Lessons are chosen anew, and must be the same ones.
      if (event.get<happening::LessonChosen>() != nullptr) {
        const auto lesson = same_lesson(log, event, room, cache, name);
        ++num_lessons;
        events.push_back(room.taught(lesson, event.at_us));
        room.apply(events.back(), cache, &lesson);
      } else {
        events.push_back(event);
        room.apply(event, cache);
      }
    }
  } catch (const Error& error) {
    if (!error.diagnostics().empty() && error.diagnostics().front().id == "E1622") throw;
    refuse_change(name, "event " + std::to_string(at) + ": " + error.what());
  }
  if (num_lessons != log.lessons.size()) refuse_change(name, "it has a lesson that was never chosen");

  return events;
}

std::vector<StoredEvent> events_of(EventFile& file, std::int64_t room) {
  std::vector<StoredEvent> events;
  file.for_each_event([&](const StoredEvent& event) { events.push_back(event); }, room);
  return events;
}

StoreBatch batch_of(const LessonLog& log, std::int64_t number, std::int64_t now_us) {
  StoreBatch batch;
  batch.rooms.push_back({number, to_json(log.setup).dump(), log.events.empty() ? now_us : log.events.front().at_us});
  for (const auto& event : log.events) {
    batch.events.push_back(to_stored(number, event));
  }
  return batch;
}

}  // namespace

Json lesson_document(const SessionStudy& session, const std::string& program) {
  if (session.study->seats_by_ability()) {
    throw Error{ErrorKind::kInfeasible, "the study seats people by their screening, and in a lesson file there is one",
                "leave group.screening.high out, or teach with 'kith serve'"};
  }
  const auto cells = live_cells(*session.study);
  RoomSetup setup;
  setup.code = "FILE";
  setup.strategy = cells.front().strategy;
  setup.composition = cells.front().composition.substr(0, 1);
  setup.salt = session.digest;
  return {{"schema", kFileSchema},    {"kith", program},          {"title", session.study->spec.title},
          {"digest", session.digest}, {"inputs", session.inputs}, {"setup", to_json(setup)}};
}

ImportedLog import_lesson_log(const std::filesystem::path& folder, std::string_view text, const std::string& name,
                              const std::string& program, std::int64_t now_us) {
  auto log = parsed_log(text, name);
  const auto session = restore_session_study(log.inputs);
  log.events = replayed(log, session, name);

  std::filesystem::create_directories(folder);
  const auto lock = FolderLock::try_acquire(folder);
  if (!lock) {
    refuse_run(ErrorKind::kBusy, "E1610", folder, "another process serves the sessions in this folder",
               "import into another folder, or wait until it ends");
  }
  auto file = EventFile::open(folder, {session.digest, program, session.inputs}, now_us);
  ImportedLog imported{.room = log.setup.id, .events = log.events.size()};
  std::int64_t number = 1;
  for (const auto& room : file.rooms()) {
    number = std::max(number, room.number + 1);
    const std::string id = room_setup(Json::parse(room.setup)).id;
    auto batch = batch_of(log, room.number, now_us);
    const auto known = events_of(file, room.number);
    const auto shared = std::min(known.size(), batch.events.size());
    const bool is_same =
        std::equal(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(shared), batch.events.begin());
    if (id != log.setup.id) {
      // No two people do the same at the same microseconds; the seal does not cover who they are.
      if (is_same && shared > 0) {
        refuse_run(ErrorKind::kUsage, "E1623", name, "the session has these answers already, as those of '" + id + "'",
                   "a copy under another name is not another person");
      }
      continue;
    }
    if (is_same) {
      batch.rooms.clear();
      batch.events.erase(batch.events.begin(), batch.events.begin() + static_cast<std::ptrdiff_t>(shared));
      imported.events = batch.events.size();
      if (imported.events > 0) file.write(std::vector{std::move(batch)});
      return imported;
    }
    refuse_run(ErrorKind::kUsage, "E1623", name, "the session has another log of the same person",
               "keep the longer one of the two, in a folder of its own");
  }
  const std::vector<StoreBatch> batches{batch_of(log, number, now_us)};
  file.write(batches);
  return imported;
}

}  // namespace kith
