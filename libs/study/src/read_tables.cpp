#include "kith/study/read_tables.hpp"

#include <algorithm>
#include <stdexcept>

#include "kith/core/error.hpp"
#include "kith/study/tables.hpp"
#include "kith/table/column_names.hpp"

namespace kith {
namespace {

[[noreturn]] void refuse_row(const std::string& file, std::size_t line, const std::string& id,
                             const std::string& message, const std::string& hint) {
  throw Error{
      std::vector<Diagnostic>{{.id = id, .message = message, .file = file, .line = line, .column = 1, .hint = hint}}};
}

const std::vector<Column>& columns_of(const std::vector<TableDescription>& tables, std::string_view table) {
  const auto found = std::find_if(tables.begin(), tables.end(), [&](const auto& one) { return one.file == table; });
  if (found == tables.end()) throw std::invalid_argument{"read_study_table: no table " + std::string{table}};
  return found->columns;
}

// The size of `columns` if none has this name.
std::size_t position(const std::vector<Column>& columns, std::string_view name) {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const auto& one) { return one.name == name; });
  return static_cast<std::size_t>(found - columns.begin());
}

// The columns that say where a team stands in the design.
std::vector<std::string> key_names(const Study& study) {
  std::vector<std::string> names{columns::kStrategy, columns::kComposition, columns::kReplicate, columns::kTeam};
  for (const auto& factor : study.variants.front().factors) names.push_back(factor.key);
  return names;
}

// Finds the team of every row and checks that the row says the same of it as the design.
class TeamKeys {
 public:
  TeamKeys(const std::string& file, const std::vector<Column>& columns, const Study& study, const TeamRegister& teams)
      : file_{file}, study_{study}, teams_{teams} {
    strategy_ = position(columns, columns::kStrategy);
    composition_ = position(columns, columns::kComposition);
    for (const auto& factor : study.variants.front().factors) factors_.push_back(position(columns, factor.key));
    replicate_ = position(columns, columns::kReplicate);
    team_ = position(columns, columns::kTeam);
  }

  std::size_t team_of(const CsvRow& row) {
    const auto number = std::get<std::int64_t>(row.cells[team_]);
    const auto team = position_of(number);
    if (team == teams_.addresses.size()) {
      refuse_row(file_, row.line, "E0620",
                 "there is no team " + std::to_string(number) + " in this study, which has " +
                     std::to_string(teams_.addresses.size()),
                 "restore the tables as the run wrote them");
    }
    if (!agrees(row, team)) {
      refuse_row(file_, row.line, "E0620",
                 "the row contradicts what inputs/study.toml says of team " + std::to_string(number),
                 "the table and inputs/study.toml must come from the same run");
    }
    if (team < last_) {
      refuse_row(file_, row.line, "E0622", "the rows of team " + std::to_string(number) + " are not adjacent",
                 "sort the table by the column team, and leave the order within a team as it was");
    }
    last_ = team;
    return team;
  }

 private:
  // Of the team with this number in the register; its size if there is none.
  [[nodiscard]] std::size_t position_of(std::int64_t number) const {
    const auto& all = teams_.addresses;
    if (number < 1) return all.size();
    const auto wanted = static_cast<std::size_t>(number);
    if (wanted <= all.size() && all[wanted - 1].team == wanted) return wanted - 1;
    const auto found = std::lower_bound(all.begin(), all.end(), wanted,
                                        [](const TeamAddress& one, std::size_t team) { return one.team < team; });
    return found != all.end() && found->team == wanted ? static_cast<std::size_t>(found - all.begin()) : all.size();
  }

  [[nodiscard]] bool agrees(const CsvRow& row, std::size_t team) const {
    const auto& address = teams_.addresses[team];
    if (std::get<std::string>(row.cells[strategy_]) != teams_.strategies[team]) return false;
    if (std::get<std::string>(row.cells[composition_]) != address.composition) return false;
    if (std::get<std::int64_t>(row.cells[replicate_]) != static_cast<std::int64_t>(address.replicate)) return false;
    const auto& settings = study_.variants[address.variant].factors;
    for (std::size_t i = 0; i < factors_.size(); ++i) {
      if (std::get<std::string>(row.cells[factors_[i]]) != settings[i].value) return false;
    }
    return true;
  }

  const std::string& file_;
  const Study& study_;
  const TeamRegister& teams_;
  std::size_t strategy_, composition_, replicate_, team_;
  std::vector<std::size_t> factors_;
  std::size_t last_ = 0;
};

}  // namespace

TeamRegister register_teams(const Study& study) {
  TeamRegister result{team_addresses(study), {}};
  result.strategies.reserve(result.addresses.size());
  for (const auto& address : result.addresses) result.strategies.emplace_back(address.strategy);
  return result;
}

TeamRegister register_teams(const Study& study, std::string_view teams_csv, const std::string& file) {
  const auto all = register_teams(study);
  TeamRegister present;
  const std::vector<std::string_view> no_columns;
  read_study_table(teams_csv, file, study, all, "teams.csv", no_columns, [&](const StudyRow& row) {
    if (!present.addresses.empty() && present.addresses.back().team == row.address().team) return;
    present.addresses.push_back(row.address());
    present.strategies.push_back(all.strategies[row.team()]);
  });
  return present;
}

const TableCell& StudyRow::cell(std::string_view column) const {
  const auto found = std::find(names_.begin(), names_.end(), column);
  if (found == names_.end()) throw std::invalid_argument{"StudyRow: no column " + std::string{column}};
  return row_.cells[static_cast<std::size_t>(found - names_.begin())];
}

const std::string& StudyRow::text(std::string_view column) const { return std::get<std::string>(cell(column)); }
bool StudyRow::boolean(std::string_view column) const { return std::get<bool>(cell(column)); }
double StudyRow::real(std::string_view column) const { return std::get<double>(cell(column)); }
bool StudyRow::has(std::string_view column) const {
  const bool is_there = std::find(names_.begin(), names_.end(), column) != names_.end();
  return is_there && !std::holds_alternative<std::monostate>(cell(column));
}

std::size_t StudyRow::count(std::string_view column, std::size_t min, std::size_t max) const {
  const auto value = std::get<std::int64_t>(cell(column));
  if (value < 0 || static_cast<std::size_t>(value) < min || static_cast<std::size_t>(value) > max) {
    refuse("E0621",
           std::to_string(value) + " is not from " + std::to_string(min) + " to " + std::to_string(max) +
               ", as it must be here",
           "restore the table as the run wrote it");
  }
  return static_cast<std::size_t>(value);
}

void StudyRow::refuse(const std::string& id, const std::string& message, const std::string& hint) const {
  refuse_row(file_, row_.line, id, message, hint);
}

std::size_t read_study_table(std::string_view text, const std::string& file, const Study& study,
                             const TeamRegister& teams, std::string_view table,
                             std::span<const std::string_view> wanted,
                             const std::function<void(const StudyRow&)>& on_row) {
  const auto tables = study_tables(study);
  const auto& all = columns_of(tables, table);
  std::vector<Column> columns;
  std::vector<std::string_view> names;
  for (const auto name : wanted) {
    const auto place = position(all, name);
    if (place == all.size()) continue;
    columns.push_back(all[place]);
    names.push_back(name);
  }
  for (const auto& name : key_names(study)) columns.push_back(all[position(all, name)]);
  TeamKeys keys{file, columns, study, teams};
  std::size_t rows = 0;
  auto diagnostics = read_csv(
      text, file, columns,
      [&](const CsvRow& row) {
        const auto team = keys.team_of(row);
        on_row({file, row, names, team, teams.addresses[team]});
        ++rows;
      },
      OtherColumns::kIgnore);
  constexpr std::size_t kShown = 20;
  if (diagnostics.size() > kShown) diagnostics.resize(kShown);
  if (!diagnostics.empty()) throw Error{std::move(diagnostics)};
  return rows;
}

}  // namespace kith
