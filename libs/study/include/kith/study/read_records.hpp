#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/study/study.hpp"

namespace kith {

/// Where records are read from.
struct RecordSource {
  std::string_view text;  ///< Of a table of a run.
  std::string file;       ///< How messages name it.
  /// What the table was written for: every row is checked against its design. Without it, the header says which columns
  /// of some studies there are, and what only a study tells (beliefs by rule, traits, half-spaces, counts) is not read.
  const Study* study = nullptr;
  std::span<const TeamAddress> teams{};  ///< Of the study, in the order of the tables: those that have rows.
};

/// The row that a record was read from.
struct RecordRow {
  const std::string& file;
  std::size_t line = 0;  ///< Where it begins in the file, from 1.
  const TeamAddress& address;
  std::size_t team = 0;                     ///< Position in RecordSource::teams; without these, in the table.
  std::span<const std::string> settings{};  ///< Of varied_keys(), if no study was given.

  /// Complains about the row. @throws kith::Error (kInvalidInput) with that id, the file and the line.
  [[noreturn]] void refuse(const std::string& id, const std::string& message, const std::string& hint) const;
  /// The value. @throws kith::Error (kInvalidInput, E0621) unless it is within [min, max].
  [[nodiscard]] std::size_t within(std::size_t value, std::size_t min, std::size_t max) const;
};

/// Reads the records of a table as declare() tells of them: the inverse of write_study_tables(). Members that only the
/// journal keeps, and those that no wanted column shows, are left as they are by default.
/// Record: one of TeamRecord, LearnerRecord, PeriodRecord, ResponseRecord, DemonstrationRecord, ProgressRecord,
/// ExamRecord and EstimateRecord.
/// @param wanted  columns to read, as far as the study has them, beside those that say where a team stands in the
///                design.
/// @param on_record  gets every record, in order; teams come in ascending order.
/// @return the number of rows.
/// @throws kith::Error (kInvalidInput) for the first fault of a row (E0620 to E0622) or all faults of the text
/// (E0501 to E0511).
template <typename Record>
std::size_t read_records(const RecordSource& source, const std::vector<std::string_view>& wanted,
                         const std::function<void(const RecordRow& row, Record& record)>& on_record);

/// The teams that have a row in teams.csv, for a run that lacks some. @param file  how messages name it.
/// @throws kith::Error as read_records() does.
[[nodiscard]] std::vector<TeamAddress> present_teams(const Study& study, std::string_view teams_csv,
                                                     const std::string& file);

/// The study's varied keys, as the header of one of its tables has them: between composition and replicate.
/// @throws kith::Error (kInvalidInput) as read_csv_header() does.
[[nodiscard]] std::vector<std::string> varied_keys(std::string_view text, const std::string& file);

}  // namespace kith
