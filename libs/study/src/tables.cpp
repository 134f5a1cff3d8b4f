#include "kith/study/tables.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <deque>

#include "kith/core/text.hpp"
#include "kith/files/csv_writer.hpp"
#include "kith/study/record_columns.hpp"

namespace kith {
namespace {

std::string blank_separated(const IntegerVector& v) {
  return joined(v, " ", [](std::int64_t entry) { return std::to_string(entry); });
}

// Counts in units of 1 / scale.
std::string counts_text(const IntegerVector& counts, std::int64_t scale) {
  if (scale == 1) return blank_separated(counts);
  return joined(counts, " ", [&](std::int64_t entry) {
    std::array<char, 32> digits{};
    const double value = static_cast<double>(entry) / static_cast<double>(scale);
    return std::string{digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
  });
}

// What a cell shows of a member of a record.
template <typename Value>
const Value& shown(const Value& value, const Study& /*study*/) {
  return value;
}
std::string_view shown(const char& letter, const Study& /*study*/) { return {&letter, 1}; }
std::string_view shown(const SessionStatus& status, const Study& /*study*/) { return name_of(status); }
std::string shown(const std::vector<HalfSpace>& half_spaces, const Study& /*study*/) {
  return joined(half_spaces, ";", [](const HalfSpace& one) { return blank_separated(one.normal()); });
}
std::optional<std::string> shown(const std::optional<IntegerVector>& counts, const Study& study) {
  if (!counts) return std::nullopt;
  return counts_text(*counts, study.variants.front().count_scale);
}

// A row of a table: a record, and where its team stands in the design.
template <typename Record>
struct RowOf {
  const TeamAddress& address;
  const Record& record;
};

// Makes the columns of a table from what declare() says of a record. The record is that of the row or a part of it,
// which `Find` looks up in the row: null where the row has none.
template <typename Row, typename Find>
class RecordColumns {
 public:
  RecordColumns(TableOf<Row>& table, const Study& study, Find find, bool is_required)
      : table_{table}, study_{study}, find_{std::move(find)}, is_required_{is_required} {}

  template <typename Value, typename Record>
  void column(Value Record::*member, const ColumnWords& words, const RecordColumn& options = {}) {
    if constexpr (std::same_as<Value, std::size_t>) {
      if (options.zero_is_missing) {
        return derived(
            [member](const Record& record) {
              const auto number = record.*member;
              return number == 0 ? std::nullopt : std::optional{number};
            },
            words, options);
      }
    }
    derived([member, &study = study_](const Record& record) -> decltype(auto) { return shown(record.*member, study); },
            words, options);
  }

  template <typename Function>
  void derived(Function function, const ColumnWords& words, const RecordColumn& options = {}) {
    if (options.when != nullptr && !options.when(study_)) return;
    using Record = std::remove_cvref_t<decltype(*find_(std::declval<const Row&>()))>;
    if constexpr (std::invocable<const Function&, const Record&, const Study&>) {
      derived([function, &study = study_](const Record& record) { return function(record, study); }, words, options);
    } else {
      add(function, words, options);
    }
  }

  template <typename Values, typename Record>
  void columns(Values Record::*member, std::vector<Column> (*list)(const Study&),
               const RecordColumn& /*options*/ = {}) {
    std::size_t i = 0;
    for (const auto& column : list(study_)) {
      const ColumnWords words{column.name, column.description, column.unit, column.kind};
      if (column.required) {
        derived([member, i](const Record& record) { return (record.*member).at(i); }, words);
      } else {
        derived(
            [member, i](const Record& record) {
              return i < (record.*member).size() ? std::optional{(record.*member)[i]} : std::nullopt;
            },
            words);
      }
      ++i;
    }
  }

  template <typename Part, typename Record>
  void part(Part Record::*member, const RecordColumn& options = {}) {
    if (options.when != nullptr && !options.when(study_)) return;
    using Held = detail::CellType<Part>;
    const auto find = [outer = find_, member](const Row& row) -> const typename Held::Type* {
      const Record* record = outer(row);
      if (record == nullptr) return nullptr;
      if constexpr (Held::kIsOptional) {
        return record->*member ? &*(record->*member) : nullptr;
      } else {
        return &(record->*member);
      }
    };
    const bool required = options.required != nullptr ? options.required(study_) : is_required_ && !Held::kIsOptional;
    RecordColumns<Row, decltype(find)> fields{table_, study_, find, required};
    declare(fields, columns::Declared<typename Held::Type>{});
  }

  template <typename Value, typename Record>
  void kept(Value Record::* /*member*/, int /*since*/ = 0) {}

  void traits(std::vector<double> LearnerRecord::*member) {
    for (const auto& column : trait_columns(study_)) {
      const auto value = [member, name = column.name, &study = study_](const Row& row) -> std::optional<double> {
        const auto& type = learner_type(study.variants.at(row.address.variant), row.record.type);
        const auto& traits = type.model->traits;
        const auto found =
            std::find_if(traits.begin(), traits.end(), [&](const auto& one) { return one.name == name; });
        if (found == traits.end()) return std::nullopt;
        return (row.record.*member).at(static_cast<std::size_t>(found - traits.begin()));
      };
      table_.column(value, {column.name, column.description, column.unit}, {.required = column.required});
    }
  }

 private:
  template <typename Function>
  void add(Function function, const ColumnWords& words, const RecordColumn& options) {
    using Record = std::remove_cvref_t<decltype(*find_(std::declval<const Row&>()))>;
    using Value = std::remove_cvref_t<std::invoke_result_t<const Function&, const Record&>>;
    using Held = detail::CellType<Value>;
    // Texts are only looked at.
    using Type = std::conditional_t<std::is_reference_v<std::invoke_result_t<const Function&, const Record&>> &&
                                        std::same_as<typename Held::Type, std::string>,
                                    std::string_view, typename Held::Type>;
    const auto cell = [find = find_, function](const Row& row) -> std::optional<Type> {
      const Record* record = find(row);
      if (record == nullptr) return std::nullopt;
      return std::invoke(function, *record);
    };
    const bool required = options.required != nullptr ? options.required(study_) : is_required_ && !Held::kIsOptional;
    table_.column(cell, words, {.required = required, .before = options.before});
  }

  TableOf<Row>& table_;
  const Study& study_;
  Find find_;
  bool is_required_;
};

// A table without the columns of its rows: what every table begins with, where a team stands in the design.
template <typename Row>
TableOf<Row> keyed_table(const Study& study, const char* file, const char* description) {
  TableOf<Row> table{file, description};
  table.column([](const Row& row) -> std::string_view { return row.address.strategy; },
               {columns::kStrategy, "How the team was taught."});
  table.column([](const Row& row) -> std::string_view { return row.address.composition; },
               {columns::kComposition, "The members' learner types, one letter each."});
  for (std::size_t i = 0; i < study.variants.front().factors.size(); ++i) {
    table.column(
        [&study, i](const Row& row) -> std::string_view {
          return study.variants.at(row.address.variant).factors[i].value;
        },
        {study.variants.front().factors[i].key, "Setting of this key of the study file, which varies in the study."});
  }
  table.column([](const Row& row) { return row.address.replicate; },
               {columns::kReplicate, "Number of the team in its cell, from 1."});
  table.column([](const Row& row) { return row.address.team; },
               columns::identifier(columns::kTeam, "Number of the team in the study, from 1."));
  return table;
}

template <typename Record>
TableOf<RowOf<Record>> record_table(const Study& study, const char* file, const char* description) {
  using Row = RowOf<Record>;
  auto table = keyed_table<Row>(study, file, description);
  const auto find = [](const Row& row) { return &row.record; };
  RecordColumns<Row, decltype(find)> fields{table, study, find, true};
  declare(fields, columns::Declared<Record>{});
  return table;
}

// A row of particles.csv.
struct ParticleRow {
  const TeamAddress& address;
  const BeliefSnapshot& belief;
  std::size_t particle;
};

// x, y, z in space; w1, w2, ... elsewhere.
void add_directions(TableOf<ParticleRow>& table, std::size_t num_features) {
  constexpr std::array kNames{"x", "y", "z"};
  constexpr std::array kWords{"First entry of a direction of reward weights, at length 1.", "Second entry.",
                              "Third entry."};
  const bool is_in_space = num_features == kNames.size();
  for (std::size_t k = 0; k < num_features; ++k) {
    const auto number = std::to_string(k + 1);
    const auto name = is_in_space ? kNames.at(k) : "w" + number;
    const auto words =
        is_in_space ? kWords.at(k) : "Entry " + number + " of a direction of reward weights, at length 1.";
    table.column(
        [k](const ParticleRow& row) { return row.belief.points[k * row.belief.weights.size() + row.particle]; },
        {name, words, "none"});
  }
}

TableOf<ParticleRow> particle_table(const Study& study) {
  using Row = ParticleRow;
  auto table = keyed_table<Row>(study, "particles.csv", "One row per particle, belief and period.");
  table.column([](const Row& row) { return row.belief.period; },
               {columns::kPeriod, "Number of the period at whose end the belief was this."});
  table.column(
      [](const Row& row) -> std::string_view { return row.belief.belief; },
      {"belief", "Whose: 'own N' (of member N), 'teacher N' (the teacher's about member N), 'common' or 'joint'."});
  table.column([](const Row& row) { return row.particle + 1; }, {"particle", "Number of the particle, from 1."});
  add_directions(table, study.variants.front().num_features);
  table.column([](const Row& row) { return row.belief.weights[row.particle]; },
               {"weight", "Weight of the particle; those of a belief sum to 1.", "share"});
  return table;
}

// A table of a study, and how it writes the rows of a team.
struct StudyTable {
  TableDescription description;
  std::function<void(CsvWriter& writer, const TeamRecord& team)> write;
};

template <typename Record>
StudyTable list_table(const Study& study, std::vector<Record> TeamRecord::*list, const char* file,
                      const char* description) {
  auto table = record_table<Record>(study, file, description);
  auto text = table.description();
  return {std::move(text), [table = std::move(table), list](CsvWriter& writer, const TeamRecord& team) {
            for (const auto& record : team.*list) table.write(writer, {team.address, record});
          }};
}

StudyTable team_table(const Study& study) {
  auto table = record_table<TeamRecord>(study, "teams.csv", "One row per team.");
  auto text = table.description();
  return {std::move(text), [table = std::move(table)](CsvWriter& writer, const TeamRecord& team) {
            table.write(writer, {team.address, team});
          }};
}

StudyTable belief_table(const Study& study) {
  auto table = particle_table(study);
  auto text = table.description();
  return {std::move(text), [table = std::move(table)](CsvWriter& writer, const TeamRecord& team) {
            for (const auto& belief : team.beliefs) {
              for (std::size_t i = 0; i < belief.weights.size(); ++i) table.write(writer, {team.address, belief, i});
            }
          }};
}

// In the order in which they are written. The study must outlive them.
std::vector<StudyTable> tables_of(const Study& study) {
  using R = TeamRecord;
  std::vector<StudyTable> tables;
  tables.push_back(team_table(study));
  tables.push_back(list_table(study, &R::learners, "learners.csv", "One row per member of a team."));
  tables.push_back(list_table(study, &R::period_records, "periods.csv",
                              "One row per interaction period; none if only teams are recorded."));
  tables.push_back(list_table(study, &R::responses, "responses.csv",
                              "One row per member and test; none if only teams are recorded."));
  tables.push_back(list_table(study, &R::demonstration_records, "demonstrations.csv",
                              "One row per demonstration shown; none if only teams are recorded."));
  tables.push_back(list_table(study, &R::progress, "progress.csv",
                              "One row per member and period; none if only teams are recorded."));

  // Tables of what only some studies record.
  if (study.variants.front().record == RecordLevel::kParticles) tables.push_back(belief_table(study));
  if (has_exam(study)) {
    tables.push_back(list_table(study, &R::exams, "exam.csv",
                                "One row per exam of a member, over all starts and over those of every component."));
  }
  if (has_discussions(study)) {
    tables.push_back(list_table(study, &R::discussions, "discussions.csv",
                                "One row per member and test of a period whose answers were discussed; none if only "
                                "teams are recorded."));
  }
  if (has_estimates(study)) {
    tables.push_back(list_table(study, &R::estimates, "estimates.csv",
                                "What the teacher can tell from the answers, beside the truth: one row about each "
                                "member, and one about each member and component, per period."));
  }
  return tables;
}

}  // namespace

std::vector<TableDescription> study_tables(const Study& study) {
  std::vector<TableDescription> descriptions;
  for (auto& table : tables_of(study)) descriptions.push_back(std::move(table.description));
  return descriptions;
}

std::string study_codebook(const Study& study, const std::string& run) { return codebook(study_tables(study), run); }

void write_study_tables(const Study& study, std::span<const TeamRecord> teams, const TableSink& sink) {
  write_study_tables(
      study,
      [&](const std::function<void(const TeamRecord& team)>& visit) {
        for (const auto& team : teams) visit(team);
      },
      sink);
}

void write_study_tables(const Study& study, const TeamSource& teams, const TableSink& sink) {
  const auto tables = tables_of(study);
  std::deque<CsvWriter> writers;
  for (const auto& table : tables) {
    writers.emplace_back(table.description.columns,
                         [&sink, &table](std::string_view piece) { sink(table.description.file, piece); });
  }
  teams([&](const TeamRecord& team) {
    for (std::size_t i = 0; i < tables.size(); ++i) tables[i].write(writers[i], team);
  });
  for (auto& writer : writers) writer.flush();
}

}  // namespace kith
