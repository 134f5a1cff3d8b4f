// kith session: what live sessions left in their folder.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include "build_facts.hpp"
#include "command.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/file_set.hpp"
#include "kith/service/lesson_log.hpp"
#include "kith/store/event_file.hpp"
#include "kith/store/session_export.hpp"
#include "kith/store/session_review.hpp"
#include "kith/store/session_study.hpp"

namespace kith::cli {
namespace {

struct SessionOptions {
  std::string action;    ///< "list", "show" ...
  std::string folder;    ///< With import: the log.
  std::string room;      ///< Id or code; empty: all rooms.
  std::size_t seat = 0;  ///< With redact: of the person; 0: everybody.
  bool dry_run = false;  ///< Change nothing.
  std::string out;       ///< Folder for tables or for the recovered session.
  bool names = false;    ///< Export what identifies people, too.
  bool text = false;     ///< Export what people wrote in their own words, too.
  bool yes = false;      ///< Replace an existing export; erase for good.
};

namespace fs = std::filesystem;

std::int64_t now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

// "2026-01-31 12:00" in UTC; "-" for no time.
std::string time_text(std::int64_t us) {
  if (us == 0) return "-";
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(std::time_t{us / 1'000'000}));
}

std::string state_of(const RoomSummary& room) {
  if (!room.ended.empty()) return "ended: " + room.ended;
  if (room.is_taught) return "taught";
  return room.has_started ? "running" : "lobby";
}

int list(const SessionOptions& options, Console& console) {
  auto file = EventFile::read(options.folder);
  const auto rooms = list_rooms(file);
  if (rooms.empty()) {
    console.print("no rooms\n");
    return 0;
  }
  TextTable table{"lllrrrrll"};
  table.add({"room", "strategy", "group", "joined", "gone", "lessons", "answers", "last event (UTC)", "state"});
  for (const auto& room : rooms) {
    table.add({room.id, room.strategy, room.composition, std::to_string(room.joined), std::to_string(room.gone),
               std::to_string(room.lessons), std::to_string(room.answers), time_text(room.last_us), state_of(room)});
  }
  console.print(table.text(console));
  return 0;
}

// The room that was named, or the only one.
StoredRoom room_to_show(EventFile& file, const SessionOptions& options) {
  if (!options.room.empty()) return find_room(file, options.room);
  const auto rooms = file.rooms();
  if (rooms.size() == 1) return rooms.front();
  refuse(fmt::format("{} has {}; say which one with --room ID", options.folder, counted(rooms.size(), "room")),
         "list the rooms with 'kith session list'");
}

int show(const SessionOptions& options, Console& console) {
  auto file = EventFile::read(options.folder);
  const auto stored = room_to_show(file, options);
  std::string text;
  file.for_each_event(
      [&](const StoredEvent& event) {
        text += fmt::format("{:>6}  {}  {:<12} {:<12} {}\n", event.seq, time_text(event.at_us), event.actor, event.type,
                            event.json);
      },
      stored.number);
  console.print(text);
  return 0;
}

// The files of an earlier export, by its list of them; nothing if the folder holds none.
std::optional<std::set<std::string>> files_of_export(const fs::path& folder) {
  const auto path = folder / "SHA256SUMS";
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return std::nullopt;
  std::set<std::string> names{path.filename().string()};
  std::istringstream sums{read_file(path)};
  for (std::string hash, name; sums >> hash >> name;) {
    if (name.find('/') == std::string::npos) names.insert(name);
  }
  return names;
}

// What the export replaces. @throws kith::Error if there is something in the folder that it must not replace.
std::set<std::string> replaced_by_export(const SessionOptions& options) {
  const fs::path folder{options.out};
  std::error_code none;
  if (!fs::exists(folder, none) || fs::is_empty(folder, none)) return {};
  const auto former = files_of_export(folder);
  if (!former) refuse(options.out + " is not empty and is no export of a session", "choose another folder");
  if (!options.yes) refuse(options.out + " exists already", Remedy::kReplaceContents);
  return *former;
}

int write_tables(const SessionOptions& options, Console& console) {
  if (options.out.empty()) refuse("kith session export needs -o DIR, the folder for the tables");
  auto file = EventFile::read(options.folder);
  SessionExportOptions what{.room = {}, .with_names = options.names, .with_text = options.text};
  if (!options.room.empty()) what.room = find_room(file, options.room).number;
  const auto study = restore_session_study(file.identity().inputs);
  TeachingCache cache{study.study->atlas};
  const auto former = replaced_by_export(options);
  FileSet files{options.out};
  const auto report =
      export_session(file, study.study, cache, what,
                     [&](std::string_view name, std::string_view piece) { files.write(std::string{name}, piece); });
  files.commit(former);
  TextTable table{"lr"};
  table.add({"table", "rows"});
  for (const auto& [name, count] : report.rows) table.add({name, std::to_string(count)});
  console.print(table.text(console));
  if (options.names || options.text) console.warning("the tables identify people; keep them accordingly");
  return 0;
}

int replay_rooms(const SessionOptions& options, Console& console) {
  auto file = EventFile::read(options.folder);
  file.verify();
  const auto study = restore_session_study(file.identity().inputs);
  TeachingCache cache{study.study->atlas};
  std::vector<StoredRoom> rooms = file.rooms();
  if (!options.room.empty()) rooms = {find_room(file, options.room)};
  std::vector<Diagnostic> problems;
  std::size_t events = 0, lessons = 0;
  for (const auto& stored : rooms) {
    const auto replayed = replay_room(file, stored, study.study, cache);
    events += replayed.events;
    lessons += replayed.lessons;
    if (replayed.problem.empty()) continue;
    problems.push_back({.id = "E1614",
                        .message = "room " + replayed.id + " does not replay to what it was: " + replayed.problem,
                        .file = options.folder,
                        .hint = "use the version of kith and the kind of machine that the session was run with"});
  }
  if (!problems.empty()) throw Error{ErrorKind::kMismatch, counted(problems.size(), "mismatch"), problems};
  console.print(fmt::format("replayed {} with {} and {}: all identical\n", counted(rooms.size(), "room"),
                            counted(events, "event"), counted(lessons, "lesson")));
  return 0;
}

int withdraw_person(const SessionOptions& options, Console& console) {
  if (options.room.empty()) refuse("kith session redact --seat needs --room ROOM, the room of the seat");
  if (!options.yes && !options.dry_run) {
    refuse("kith session redact erases this person for good",
           "see with --dry-run what goes and export what you need, then add --yes");
  }
  TextTable table{"lr"};
  table.add({"events", "changed"});
  for (const auto& [type, count] : withdraw(options.folder, options.room, options.seat, now_us(), options.dry_run)) {
    table.add({type, std::to_string(count)});
  }
  console.print(table.text(console));
  console.print(
      options.dry_run
          ? "nothing was changed. Names, answers, paths, times, query parameters and links of this person go\n"
          : "erased; exports and audits leave this person out. Backups and earlier exports still hold it\n");
  return 0;
}

int erase_persons(const SessionOptions& options, Console& console) {
  if (options.seat != 0) return withdraw_person(options, console);
  if (!options.yes) {
    refuse("kith session redact erases names, free text and query parameters for good",
           "export what you need first, then add --yes");
  }
  const auto room = options.room.empty() ? std::nullopt : std::optional{options.room};
  if (options.dry_run) refuse("kith session redact --dry-run needs --room and --seat", "add the seat of the person");
  const auto changed = redact(options.folder, room, now_us());
  console.print(fmt::format("erased what identifies people in {}; backups and exports still hold it\n",
                            counted(changed, "event")));
  return 0;
}

int salvage(const SessionOptions& options, Console& console) {
  if (options.out.empty()) refuse("kith session salvage needs -o DIR, the folder for the recovered session");
  const auto report = salvage_session(options.folder, options.out);
  console.print(fmt::format("recovered {} and {} in {}\n", counted(report.rooms, "room"),
                            counted(report.events, "event"), options.out));
  for (const auto& lost : report.lost) console.warning("missing: " + lost);
  return report.lost.empty() ? 0 : 6;
}

int import_log(const SessionOptions& options, Console& console) {
  if (options.out.empty()) refuse("kith session import needs -o DIR, the folder for the session");
  const auto imported =
      import_lesson_log(options.out, read_file(options.folder), options.folder, program_name(), now_us());
  console.print(imported.events == 0 ? fmt::format("{} has this log already\n", options.out)
                                     : fmt::format("replayed {} and added them to {} as room {}\n",
                                                   counted(imported.events, "event"), options.out, imported.room));
  return 0;
}

void declare(OptionList& list, SessionOptions& options) {
  list.word("action", options.action, "ACTION", {"list", "show", "export", "replay", "redact", "salvage", "import"},
            "What to do")
      .required();
  list.text("folder", options.folder, "DIR", "Folder that kith serve was given; with import: a log of a lesson file")
      .required();
  list.text("--room", options.room, "ID", "Only this room, by id or code");
  list.integer("--seat", options.seat, {1}, "With redact and --room: withdraw the person in this seat");
  list.text("-o,--out", options.out, "DIR", "Folder for tables, the recovered session or the imported one");
  list.flag("--names", options.names, "Export names, query parameters and completion codes, too");
  list.flag("--text", options.text, "Export what people wrote in their own words, too");
  list.flag("--dry-run", options.dry_run, "With redact --seat: only say what would be erased");
  list.flag("--yes", options.yes, "Replace an existing export; with redact: erase for good");
}

int run(const SessionOptions& options, Console& console) {
  if (options.action == "list") return list(options, console);
  if (options.action == "show") return show(options, console);
  if (options.action == "export") return write_tables(options, console);
  if (options.action == "replay") return replay_rooms(options, console);
  if (options.action == "redact") return erase_persons(options, console);
  if (options.action == "import") return import_log(options, console);
  return salvage(options, console);
}

}  // namespace

void add_session(Commands& commands) {
  commands.add<SessionOptions>(
      "session", "List, export, replay, redact, recover or import live sessions",
      {"kith session list results/live", "kith session export results/live -o tables",
       "kith session replay results/live --room r3", "kith session redact results/live --room r3 --seat 2 --dry-run",
       "kith session import answers.json -o results/lesson"},
      declare, run);
}

}  // namespace kith::cli
