#include "kith/study/read_records.hpp"

#include <algorithm>
#include <concepts>
#include <type_traits>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/column_names.hpp"
#include "kith/files/csv_reader.hpp"
#include "kith/study/record_columns.hpp"
#include "vectors.hpp"

namespace kith {
namespace {

constexpr const char* kRestore = "restore the table as the run wrote it";

template <typename Record>
using SetCell = std::function<void(const TableCell&, const RecordRow&, Record&)>;

// How a cell becomes a member of a record; missing cells leave it alone.
class CellReader {
 public:
  CellReader(const Study* study, const Column& column) : study_{study}, column_{column} {}

  template <typename Value>
  void operator()(const TableCell& cell, const RecordRow& row, Value& value) const {
    using Held = detail::CellType<Value>;
    if constexpr (Held::kIsOptional) {
      (*this)(cell, row, value.emplace());
    } else if constexpr (std::same_as<Value, std::size_t>) {
      const auto number = std::get<std::int64_t>(cell);
      if (number < 0) row.refuse("E0621", std::to_string(number) + " is below 0, which cannot be here", kRestore);
      value = static_cast<std::size_t>(number);
      if (column_.name == columns::kMember) static_cast<void>(row.within(value, 1, row.address.composition.size()));
    } else if constexpr (std::same_as<Value, double>) {
      constexpr double kSlack = 1e-9;  // sums of weights may exceed 1 by rounding
      value = std::get<double>(cell);
      if (column_.unit == "share" && !(value >= 0.0 && value <= 1.0 + kSlack))
        row.refuse("E0621", "a share in column '" + column_.name + "' must be from 0 to 1", kRestore);
    } else if constexpr (std::same_as<Value, bool> || std::same_as<Value, std::string>) {
      value = std::get<Value>(cell);
    } else {
      read(std::get<std::string>(cell), row, value);
    }
  }

  template <typename Value>
  [[nodiscard]] static constexpr ColumnType type_of() {
    if constexpr (std::is_arithmetic_v<Value> && !std::same_as<Value, char>) {
      return detail::column_type<Value>();
    } else {
      return ColumnType::kText;
    }
  }
  // Whether it takes a study to make a value of a cell.
  template <typename Value>
  static constexpr bool kNeedsStudy = std::same_as<Value, IntegerVector> || std::same_as<Value, std::vector<HalfSpace>>;

 private:
  void read(const std::string& text, const RecordRow& row, char& letter) const {
    if (text.size() != 1) row.refuse("E0621", "'" + text + "' is no letter of a learner type", kRestore);
    letter = text.front();
  }
  void read(const std::string& text, const RecordRow& row, SessionStatus& status) const {
    for (const auto one :
         {SessionStatus::kRunning, SessionStatus::kComplete, SessionStatus::kSkipped, SessionStatus::kMaxPeriods}) {
      if (text == name_of(one)) {
        status = one;
        return;
      }
    }
    row.refuse("E0621", "'" + text + "' is no status of a team", kRestore);
  }
  void read(const std::string& text, const RecordRow& row, std::vector<HalfSpace>& half_spaces) const {
    auto parsed = detail::parse_half_spaces(text, num_features());
    if (!parsed)
      row.refuse("E0621",
                 "'" + column_.name + "' does not hold half-spaces, normals of " + std::to_string(num_features()) +
                     " whole numbers each, such as 1 0 -4;0 -1 2",
                 kRestore);
    half_spaces = *std::move(parsed);
  }
  void read(const std::string& text, const RecordRow& row, IntegerVector& counts) const {
    const auto parsed = detail::parse_counts(text, num_features(), study_->variants.front().count_scale);
    if (!parsed)
      row.refuse(
          "E0621",
          "'" + column_.name + "' does not hold " + std::to_string(num_features()) + " feature counts such as 0 1 5",
          kRestore);
    counts = *parsed;
  }
  [[nodiscard]] std::size_t num_features() const { return study_->variants.front().num_features; }

  const Study* study_;
  Column column_;
};

// The columns of a table that are read, and what becomes of their cells.
template <typename Record>
struct ReadPlan {
  const Study* study;
  std::vector<std::string> header;  // of the file
  std::vector<std::string_view> wanted;
  std::vector<Column> columns{};
  std::vector<SetCell<Record>> cells{};

  [[nodiscard]] bool has(std::string_view name) const { return std::ranges::find(header, name) != header.end(); }
  [[nodiscard]] bool wants(std::string_view name, bool (*when)(const Study&)) const {
    if (std::ranges::find(wanted, name) == wanted.end()) return false;
    return when == nullptr || (study != nullptr ? when(*study) : has(name));
  }
  void add(Column column, SetCell<Record> cell) {
    columns.push_back(std::move(column));
    cells.push_back(std::move(cell));
  }
};

// Tells a plan what declare() says of a record, or of a part of it that `Find` makes and finds in the record.
template <typename Record, typename Find>
class ReadFields {
 public:
  ReadFields(ReadPlan<Record>& plan, Find find, bool is_required, bool (*when)(const Study&))
      : plan_{plan}, find_{std::move(find)}, is_required_{is_required}, when_{when} {}

  template <typename Value, typename Part>
  void column(Value Part::*member, const ColumnWords& words, const RecordColumn& options = {}) {
    using Held = detail::CellType<Value>;
    if (!plan_.wants(words.name, options.when != nullptr ? options.when : when_)) return;
    if (CellReader::kNeedsStudy<typename Held::Type> && plan_.study == nullptr) return;
    const bool is_required = options.required != nullptr ? plan_.study != nullptr && options.required(*plan_.study)
                                                         : is_required_ && !Held::kIsOptional;
    const Column column{.name = std::string{words.name},
                        .type = CellReader::type_of<typename Held::Type>(),
                        .unit = std::string{words.unit},
                        .required = is_required && !options.zero_is_missing};
    plan_.add(column, [read = CellReader{plan_.study, column}, find = find_, member](
                          const TableCell& cell, const RecordRow& row, Record& record) {
      read(cell, row, find(record).*member);
    });
  }

  template <typename Function>
  void derived(Function function, const ColumnWords& words, const RecordColumn& options = {}) {
    if constexpr (std::is_member_object_pointer_v<Function>) column(function, words, options);
  }

  template <typename Values, typename Part>
  void columns(Values Part::*member, std::vector<Column> (*list)(const Study&), const RecordColumn& options = {}) {
    if (plan_.study == nullptr) return;
    const auto all = list(*plan_.study);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!plan_.wants(all[i].name, options.when != nullptr ? options.when : when_)) continue;
      plan_.add(all[i], [read = CellReader{plan_.study, all[i]}, find = find_, member, i](
                            const TableCell& cell, const RecordRow& row, Record& record) {
        auto& values = find(record).*member;
        if constexpr (requires { values.resize(i); }) values.resize(std::max(values.size(), i + 1));
        read(cell, row, values.at(i));
      });
    }
  }

  template <typename Held, typename Part>
  void part(Held Part::*member, const RecordColumn& options = {}) {
    using Type = typename detail::CellType<Held>::Type;
    const auto find = [outer = find_, member](Record& record) -> Type& {
      auto& held = outer(record).*member;
      if constexpr (detail::CellType<Held>::kIsOptional) {
        return held ? *held : held.emplace();
      } else {
        return held;
      }
    };
    const bool is_required = options.required != nullptr || (is_required_ && !detail::CellType<Held>::kIsOptional);
    ReadFields<Record, decltype(find)> fields{plan_, find, is_required, options.when};
    declare(fields, columns::Declared<Type>{});
  }

  template <typename Value, typename Part>
  void kept(Value Part::* /*member*/, int /*since*/ = 0) {}

  // Of people whose model has them, in its order.
  void traits(std::vector<double> LearnerRecord::*member) {
    if (plan_.study == nullptr) return;
    for (const auto& column : trait_columns(*plan_.study)) {
      if (!plan_.wants(column.name, nullptr)) continue;
      plan_.add(column, [read = CellReader{plan_.study, column}, &study = *plan_.study, name = column.name, member](
                            const TableCell& cell, const RecordRow& row, LearnerRecord& record) {
        for (const auto& type : study.variants.at(row.address.variant).learner_types) {
          if (type.letter != record.type) continue;
          const auto& all = type.model->traits;
          (record.*member).resize(all.size());
          for (std::size_t i = 0; i < all.size(); ++i) {
            if (all[i].name == name) read(cell, row, (record.*member)[i]);
          }
        }
      });
    }
  }

 private:
  ReadPlan<Record>& plan_;
  Find find_;
  bool is_required_;
  bool (*when_)(const Study&);
};

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const auto& column : columns) names.push_back(column.name);
  return names;
}

std::vector<std::string> varied_keys(const std::vector<std::string>& header) {
  const auto begin = std::ranges::find(header, columns::kComposition);
  const auto end = std::find(begin, header.end(), columns::kReplicate);
  return end == header.end() ? std::vector<std::string>{} : std::vector<std::string>{begin + 1, end};
}

// The columns that say where a team stands in the design, which are the first ones that are read: strategy,
// composition, replicate, team and varied keys.
std::vector<Column> key_columns(const std::vector<std::string>& varied) {
  std::vector<Column> columns{{columns::kStrategy, ColumnType::kText},
                              {columns::kComposition, ColumnType::kText},
                              {columns::kReplicate, ColumnType::kInteger},
                              {columns::kTeam, ColumnType::kInteger}};
  for (const auto& key : varied) columns.push_back({key, ColumnType::kText});
  for (auto& column : columns) column.required = true;
  return columns;
}

// What the keys of a row say.
struct RowKeys {
  TeamAddress address;
  std::int64_t team = 0;
  std::vector<std::string> settings{};
};

RowKeys keys_of(std::span<const TableCell> cells) {
  const auto text = [&](std::size_t i) { return std::get<std::string>(cells[i]); };
  const auto number = [&](std::size_t i) { return std::get<std::int64_t>(cells[i]); };
  RowKeys keys{.address = {.strategy = text(0),
                           .composition = text(1),
                           .replicate = static_cast<std::size_t>(number(2)),
                           .team = static_cast<std::size_t>(number(3))},
               .team = number(3)};
  for (std::size_t i = 4; i < cells.size(); ++i) keys.settings.push_back(text(i));
  return keys;
}

// Finds the team of every row in a design and checks that the row says the same of it.
class DesignedTeams {
 public:
  explicit DesignedTeams(const RecordSource& source) : source_{source} {}

  std::size_t team_of(const RowKeys& keys, const RecordRow& row) {
    const auto& all = source_.teams;
    const auto found = std::ranges::lower_bound(all, keys.address.team, {}, &TeamAddress::team);
    if (keys.team < 1 || found == all.end() || found->team != keys.address.team) {
      row.refuse(
          "E0620",
          "there is no team " + std::to_string(keys.team) + " in this study, which has " + std::to_string(all.size()),
          "restore the tables as the run wrote them");
    }
    if (!agrees(keys, *found)) {
      row.refuse("E0620", "the row contradicts what inputs/study.toml says of team " + std::to_string(keys.team),
                 "the table and inputs/study.toml must come from the same run");
    }
    const auto team = static_cast<std::size_t>(found - all.begin());
    if (team < last_) {
      row.refuse("E0622", "the rows of team " + std::to_string(keys.team) + " are not adjacent",
                 "sort the table by the column team, and leave the order within a team as it was");
    }
    last_ = team;
    return team;
  }

 private:
  [[nodiscard]] bool agrees(const RowKeys& keys, const TeamAddress& address) const {
    const auto& settings = source_.study->variants[address.variant].factors;
    return keys.address.strategy == address.strategy && keys.address.composition == address.composition &&
           keys.address.replicate == address.replicate &&
           std::ranges::equal(keys.settings, settings, {}, {}, &FactorSetting::value);
  }

  const RecordSource& source_;
  std::size_t last_ = 0;
};

template <typename Record>
std::size_t read_rows(const RecordSource& source, const std::vector<std::string_view>& wanted,
                      const std::function<void(const RecordRow& row, Record& record)>& on_record) {
  ReadPlan<Record> plan{source.study, names_of(read_csv_header(source.text, source.file)), wanted};
  std::vector<std::string> varied;
  if (source.study == nullptr) {
    varied = varied_keys(plan.header);
  } else {
    for (const auto& factor : source.study->variants.front().factors) varied.push_back(factor.key);
  }
  plan.columns = key_columns(varied);
  const auto num_keys = plan.columns.size();
  const auto itself = [](Record& record) -> Record& { return record; };
  ReadFields<Record, decltype(itself)> fields{plan, itself, true, nullptr};
  declare(fields, columns::Declared<Record>{});

  DesignedTeams teams{source};
  std::size_t rows = 0;
  auto diagnostics = read_csv(
      source.text, source.file, plan.columns,
      [&](const CsvRow& cells) {
        const auto keys = keys_of(cells.cells.first(num_keys));
        RecordRow row{source.file, cells.line, keys.address, rows, keys.settings};
        if (source.study != nullptr) row.team = teams.team_of(keys, row);
        const RecordRow placed{source.file, cells.line, source.study != nullptr ? source.teams[row.team] : keys.address,
                               row.team, keys.settings};
        Record record;
        if constexpr (std::same_as<Record, TeamRecord>) record.address = placed.address;
        for (std::size_t i = num_keys; i < cells.cells.size(); ++i) {
          if (!std::holds_alternative<std::monostate>(cells.cells[i]))
            plan.cells[i - num_keys](cells.cells[i], placed, record);
        }
        on_record(placed, record);
        ++rows;
      },
      OtherColumns::kIgnore);
  constexpr std::size_t kShown = 20;
  if (diagnostics.size() > kShown) diagnostics.resize(kShown);
  if (!diagnostics.empty()) throw Error{std::move(diagnostics)};
  return rows;
}

}  // namespace

void RecordRow::refuse(const std::string& id, const std::string& message, const std::string& hint) const {
  throw Error{{Diagnostic{.id = id, .message = message, .file = file, .line = line, .column = 1, .hint = hint}}};
}

std::size_t RecordRow::within(std::size_t value, std::size_t min, std::size_t max) const {
  if (value >= min && value <= max) return value;
  refuse("E0621",
         std::to_string(value) + " is not from " + std::to_string(min) + " to " + std::to_string(max) +
             ", as it must be here",
         kRestore);
}

std::vector<std::string> varied_keys(std::string_view text, const std::string& file) {
  return varied_keys(names_of(read_csv_header(text, file)));
}

template <typename Record>
std::size_t read_records(const RecordSource& source, const std::vector<std::string_view>& wanted,
                         const std::function<void(const RecordRow& row, Record& record)>& on_record) {
  return read_rows(source, wanted, on_record);
}

template <typename Record>
using OnRecord = std::function<void(const RecordRow& row, Record& record)>;
using Wanted = const std::vector<std::string_view>&;
template std::size_t read_records(const RecordSource&, Wanted, const OnRecord<TeamRecord>&);
template std::size_t read_records(const RecordSource&, Wanted, const OnRecord<LearnerRecord>&);
template std::size_t read_records(const RecordSource&, Wanted, const OnRecord<PeriodRecord>&);
template std::size_t read_records(const RecordSource&, Wanted, const OnRecord<ResponseRecord>&);
template std::size_t read_records(const RecordSource&, Wanted, const OnRecord<DemonstrationRecord>&);
template std::size_t read_records(const RecordSource&, Wanted, const OnRecord<ProgressRecord>&);
template std::size_t read_records(const RecordSource&, Wanted, const OnRecord<ExamRecord>&);
template std::size_t read_records(const RecordSource&, Wanted, const OnRecord<EstimateRecord>&);

std::vector<TeamAddress> present_teams(const Study& study, std::string_view teams_csv, const std::string& file) {
  const auto all = team_addresses(study);
  std::vector<TeamAddress> present;
  read_records<TeamRecord>({teams_csv, file, &study, all}, {}, [&](const RecordRow& row, const TeamRecord& /*team*/) {
    if (present.empty() || present.back().team != row.address.team) present.push_back(row.address);
  });
  return present;
}

}  // namespace kith
