#include "kith/store/session_export.hpp"

#include "kith/core/error.hpp"
#include "kith/explain/json.hpp"
#include "kith/files/published_run.hpp"
#include "kith/store/json_members.hpp"
#include "room_export.hpp"

namespace kith {
namespace {

// What was taught, and to whom.
Json about(const EventFile& file, const LiveStudy& study) {
  const auto facts = live_study_json(study);
  Json strategies = Json::array();
  for (const auto& strategy : facts["strategies"]) strategies.push_back(strategy["name"]);
  return {{"schema", "kith.session-tables/1"},
          {"session", file.id()},
          {"study", study.spec.id},
          {"title", study.spec.title},
          {"domain", facts["domain"]},
          {"program", file.identity().program},
          {"created_ms", ms_of(file.created_us())},
          {"strategies", strategies},
          {"compositions", facts["compositions"]},
          {"types", facts["types"]},
          {"inputs", file.identity().inputs}};
}

// Compares the numbers of rows with those of the store. @throws kith::Error
void reconcile(const std::filesystem::path& path, const char* file, std::size_t rows, std::size_t stored) {
  if (rows == stored) return;
  refuse_run(ErrorKind::kIo, "E1615", path,
             std::string{"the export is incomplete: "} + file + " has " + std::to_string(rows) + " rows, the session " +
                 std::to_string(stored),
             "repeat the export; if it fails again, check the disk");
}

// People who found no seat have a code, and no room.
void write_turned_away(EventFile& file, const ExportTables& tables, TableWriters& write) {
  const auto take = [&](const StoredEvent& event) {
    const auto body = body_of(event);
    if (event.type != "turned-away" || body.empty()) return;  // empty: somebody withdrew
    write.add(tables.participants, {.stage = "full",
                                    .status = "full",
                                    .query = printable(body.at("query").dump()),
                                    .code = if_any(text_at(body, "code"))});
  };
  file.for_each_event(take, 0);
}

}  // namespace

ExportReport export_session(EventFile& file, const std::shared_ptr<const LiveStudy>& study, TeachingCache& cache,
                            const SessionExportOptions& options, const ExportSink& sink) {
  auto told = options;
  told.with_discussions = study->group().discussion.choice.is_held();
  told.with_exams = study->group().exam;
  told.with_world_names = !study->spec.world_names.empty();
  const ExportTables tables{told};
  TableWriters write{told, sink};
  std::size_t rooms = 0;
  std::size_t events = 0;
  bool is_there = !options.room;
  for (const auto& stored : file.rooms()) {
    if (options.room && stored.number != *options.room) continue;
    is_there = true;
    rooms += room_setup(Json::parse(stored.setup)).is_waiting_list ? 0u : 1u;
    const auto history = read_history(file, stored, study, cache);
    auto audits = audit_room(cache, *study, history.room->setup(), history.people);
    std::erase_if(audits, [&](const auto& one) { return history.withdrawn.count(one.seat) != 0; });
    const RoomExport room{*study, told, tables, write, history, audits};
    write_room(room);
    write_answers(room);
    events += history.withdrawn.empty() ? file.count_events(stored.number) : history.events.size();
  }
  if (!is_there) {
    refuse_run(ErrorKind::kInvalidInput, "E1618", file.path(), "there is no such room in this session",
               "list the rooms with 'kith session list'");
  }
  if (told.with_names && !told.room) write_turned_away(file, tables, write);
  const auto report = write.finish(export_tables(told), file.identity().study, about(file, *study));
  reconcile(file.path(), kSessionsFile, report.rows.at(kSessionsFile), rooms);
  reconcile(file.path(), kEventsFile, report.rows.at(kEventsFile), events);
  return report;
}

}  // namespace kith
