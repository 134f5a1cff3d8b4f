#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "export_tables.hpp"
#include "kith/files/csv_writer.hpp"
#include "kith/files/sha256.hpp"
#include "kith/live/room_audit.hpp"
#include "kith/store/session_export.hpp"
#include "room_history.hpp"

namespace kith {

// The writers of all tables; hashes what they write.
class TableWriters {
 public:
  TableWriters(const SessionExportOptions& options, const ExportSink& sink) : sink_{sink} {
    for (auto& table : export_tables(options)) {
      const auto file = table.file;
      hashes_.try_emplace(file);
      writers_.try_emplace(file, std::move(table.columns), [this, file](std::string_view piece) { put(file, piece); });
    }
  }
  template <typename Row>
  void add(const TableOf<Row>& table, const Row& row) {
    table.write(writers_.at(table.description().file), row);
  }

  void put(const std::string& file, std::string_view piece) {
    hashes_[file].update(piece);
    sink_(file, piece);
  }

  ExportReport finish(const std::vector<TableDescription>& tables, const std::string& run, const Json& about) {
    ExportReport report;
    for (auto& [file, writer] : writers_) {
      writer.flush();
      report.rows[file] = writer.num_rows();
    }
    put("codebook.json", codebook(tables, run));
    put(kAboutFile, about.dump(2) + "\n");
    std::string sums;
    for (auto& [file, hash] : hashes_) {
      report.hashes[file] = std::move(hash).hex();
      sums += report.hashes[file] + "  " + file + "\n";
    }
    sink_("SHA256SUMS", sums);
    return report;
  }

 private:
  const ExportSink& sink_;
  std::map<std::string, Sha256> hashes_;
  std::map<std::string, CsvWriter> writers_;
};

// What a row of tests.csv is about.
struct ExportedAnswer {
  std::size_t period = 0;
  std::size_t test = 0;  // from 0
  std::size_t seat = 0;
  std::size_t member = 0;
  const AnswerRow* answer = nullptr;  // null: of a stand-in
  [[nodiscard]] auto key() const { return std::tuple{period, test, member, seat}; }
};

// A room whose rows are written.
struct RoomExport {
  const LiveStudy& study;
  const SessionExportOptions& options;
  const ExportTables& tables;
  TableWriters& write;
  const RoomHistory& history;
  const std::vector<AuditedPerson>& audits;  // of history.people

  [[nodiscard]] const std::string& id() const { return history.replayed.id; }
  [[nodiscard]] const RoomSetup& setup() const { return history.room->setup(); }
  [[nodiscard]] const Session& session() const { return history.room->session(); }
  // Of people and stand-ins, in the order of the table.
  [[nodiscard]] std::vector<ExportedAnswer> given_answers() const;
};

// Who was there, what was taught, what the teacher believed, and all events.
void write_room(const RoomExport& room);
// What people and stand-ins answered, tests and questions.
void write_answers(const RoomExport& room);

// --- cells -----------------------------------------------------------------------------------------------------------

inline std::int64_t ms_of(std::int64_t us) { return us / 1000; }
inline std::optional<std::int64_t> ms_if_any(std::int64_t us) {
  return us == 0 ? std::nullopt : std::optional<std::int64_t>{us / 1000};
}
inline std::optional<std::string> if_any(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional{text};
}
inline std::optional<double> share(std::size_t part, std::size_t all) {
  return all == 0 ? std::nullopt : std::optional{static_cast<double>(part) / static_cast<double>(all)};
}
// CSV cells hold no zero bytes.
inline std::string printable(std::string text) {
  std::erase(text, '\0');
  return text;
}

}  // namespace kith
