#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/study/study.hpp"
#include "kith/table/csv_reader.hpp"

namespace kith {

/// The teams of a design, as rows of its tables refer to them.
struct TeamRegister {
  std::vector<TeamAddress> addresses;   ///< In the order of the tables, which is that of their numbers.
  std::vector<std::string> strategies;  ///< Per team, as files name it.
};
[[nodiscard]] TeamRegister register_teams(const Study& study);
/// Those of them that have a row in teams.csv, for a run that lacks some. @param file  how messages name it.
/// @throws kith::Error as read_study_table() does.
[[nodiscard]] TeamRegister register_teams(const Study& study, std::string_view teams_csv, const std::string& file);

/// One row of a table of a run: the team that it belongs to, and the cells that were asked for.
class StudyRow {
 public:
  /// The first cells of the row are those of `names`. All arguments must outlive the object.
  StudyRow(const std::string& file, const CsvRow& row, std::span<const std::string_view> names, std::size_t team,
           const TeamAddress& address)
      : file_{file}, row_{row}, names_{names}, team_{team}, address_{address} {}

  /// Position of the team in the register, from 0: one less than its number if all teams are in it.
  [[nodiscard]] std::size_t team() const noexcept { return team_; }
  [[nodiscard]] const TeamAddress& address() const noexcept { return address_; }
  /// Where the row begins in the file, from 1.
  [[nodiscard]] std::size_t line() const noexcept { return row_.line; }

  // The cell of a column, which was asked for and has that type.

  [[nodiscard]] const std::string& text(std::string_view column) const;
  /// Whether the cell has a value; those of required columns do, those of columns that the study lacks do not.
  [[nodiscard]] bool has(std::string_view column) const;
  [[nodiscard]] bool boolean(std::string_view column) const;
  [[nodiscard]] double real(std::string_view column) const;
  /// @throws kith::Error (kInvalidInput, E0621) unless the cell is within [min, max].
  [[nodiscard]] std::size_t count(std::string_view column, std::size_t min, std::size_t max) const;

  /// Complains about this row. @throws kith::Error (kInvalidInput) with that id, the file and the line.
  [[noreturn]] void refuse(const std::string& id, const std::string& message, const std::string& hint) const;

 private:
  [[nodiscard]] const TableCell& cell(std::string_view column) const;

  const std::string& file_;
  const CsvRow& row_;
  std::span<const std::string_view> names_;
  std::size_t team_;
  const TeamAddress& address_;
};

/// Reads columns of a table of a run from its text: each is checked against its type, every row against the design.
/// Other columns are not looked at.
/// @param file    how messages name it. @param table  such as "periods.csv", see study_tables().
/// @param wanted  names of the columns to hand out, as far as the study has them, without those that say where a team
///                stands in the design.
/// @param on_row  gets every row, in order; teams come in ascending order.
/// @return the number of rows.
/// @throws kith::Error (kInvalidInput) for the first fault of a row (E0620 to E0622) or all faults of the text
/// (E0501 to E0511); std::invalid_argument for a table that the study does not have.
std::size_t read_study_table(std::string_view text, const std::string& file, const Study& study,
                             const TeamRegister& teams, std::string_view table,
                             std::span<const std::string_view> wanted,
                             const std::function<void(const StudyRow&)>& on_row);

}  // namespace kith
