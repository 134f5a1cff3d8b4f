#include "run_data.hpp"

#include <cmath>
#include <limits>

namespace kith::detail {
namespace {

constexpr std::size_t kNoTeam = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kManyRows = std::size_t{1} << 15;

class DataReader {
 public:
  DataReader(const RunFiles& run, const ReportDesign& design, std::size_t num_components,
             const std::function<void(std::string_view)>& on_step)
      : run_{run}, design_{design}, on_step_{on_step} {
    data_.num_components = num_components;
  }

  RunData read() && {
    read_teams();
    data_.has_periods = run_.spec().record != RecordLevel::kTeam;
    if (data_.has_periods) {
      read_periods();
      read_progress();
      read_responses();
    }
    return std::move(data_);
  }

 private:
  using Names = std::vector<std::string_view>;

  std::size_t read_table(const std::string& table, const Names& wanted,
                         const std::function<void(const StudyRow&)>& on_row) {
    const auto step = "reading " + table;
    on_step_(step);
    const auto text = table_text(run_, table);
    const auto file = (run_.folder / "tables" / table).string();
    std::size_t rows = 0;
    return read_study_table(text, file, run_.study, run_.teams, table, wanted, [&](const StudyRow& row) {
      if (++rows % kManyRows == 0) on_step_(step);
      on_row(row);
    });
  }

  void read_teams() {
    const auto num_teams = run_.teams.addresses.size();
    data_.teams.resize(num_teams);
    std::size_t last = kNoTeam;
    const auto rows = read_table("teams.csv", {"completed", "periods", "knowledge", "area_sr"}, [&](const auto& row) {
      if (row.team() == last) {
        row.refuse("E0606", "team " + std::to_string(last + 1) + " occurs twice", "remove the second row");
      }
      last = row.team();
      const auto most = max_period(row) * row.address().composition.size();
      data_.teams[last] = {row.boolean(0), static_cast<double>(row.count(1, 0, most)), fraction(row, 2), row.real(3)};
    });
    if (rows == num_teams) return;
    refuse_run(ErrorKind::kInvalidInput, "E0606", run_.folder / "tables" / "teams.csv",
               "the table has " + std::to_string(rows) + " teams, the study " + std::to_string(num_teams),
               "restore the table, or run the study again with the same -o");
  }

  void read_periods() {
    data_.components.resize(data_.teams.size() * data_.num_components);
    std::size_t team = kNoTeam, component = 0, last_period = 0;
    read_table("periods.csv", {"period", "kc", "area_sr"}, [&](const StudyRow& row) {
      const auto period = period_of(row, 0);
      const auto kc = component_of(row, 1);
      // In the baseline the periods of the next member begin at 1 again.
      const bool first = row.team() != team || kc != component || period <= last_period;
      team = row.team();
      component = kc;
      last_period = period;
      auto& values = data_.components[team * data_.num_components + kc];
      ++values.periods;
      if (first) return;
      const double area = row.real(2);
      if (!(area > 0.0)) row.refuse("E0621", "an area must be greater than 0", "restore the table as the run wrote it");
      ++values.later_periods;
      values.log_area_sum += std::log(area);
      values.area_sum += area;
    });
  }

  void read_progress() {
    std::size_t team = kNoTeam;
    std::vector<std::size_t> seen;  // shape [members, components]: periods of the component so far
    read_table("progress.csv", {"period", "kc", "member", "ability", "p_bec"}, [&](const StudyRow& row) {
      if (row.team() != team) seen.assign(row.address().composition.size() * data_.num_components, 0);
      team = row.team();
      const auto period = period_of(row, 0);
      const auto kc = component_of(row, 1);
      const auto member = member_of(row, 2);
      const auto [series, type] = place(row, member);
      const auto in_component = ++seen[member * data_.num_components + kc];
      data_.ability[{series, type, kc, in_component}].push_back(fraction(row, 3));
      data_.knowledge[{series, type, 0, period}].push_back(fraction(row, 4));
    });
  }

  void read_responses() {
    read_table("responses.csv", {"period", "test", "member", "correct"}, [&](const StudyRow& row) {
      const auto period = period_of(row, 0);
      const auto [series, type] = place(row, member_of(row, 2));
      auto& values = data_.answers[{series, type, 0, period}];
      if (row.count(1, 1, kMax) == 1) ++values.people;
      ++values.answers;
      if (row.boolean(3)) ++values.correct;
    });
  }

  [[nodiscard]] std::size_t max_period(const StudyRow& row) const {
    return run_.study.variants[row.address().variant].teaching.max_periods;
  }
  [[nodiscard]] std::size_t period_of(const StudyRow& row, std::size_t i) const {
    return row.count(i, 1, max_period(row));
  }
  [[nodiscard]] std::size_t component_of(const StudyRow& row, std::size_t i) const {
    return row.count(i, 1, data_.num_components) - 1;
  }
  [[nodiscard]] static std::size_t member_of(const StudyRow& row, std::size_t i) {
    return row.count(i, 1, row.address().composition.size()) - 1;
  }
  [[nodiscard]] static double fraction(const StudyRow& row, std::size_t i) {
    const double value = row.real(i);
    constexpr double kSlack = 1e-9;  // sums of weights may exceed 1 by rounding
    if (!(value >= 0.0 && value <= 1.0 + kSlack)) {
      row.refuse("E0621", "a mass or an ability must be from 0 to 1", "restore the table as the run wrote it");
    }
    return value;
  }

  struct Place {
    std::size_t series;
    std::size_t type;
  };
  [[nodiscard]] Place place(const StudyRow& row, std::size_t member) const {
    const char letter = row.address().composition[member];
    std::size_t type = 0;
    while (run_.types()[type].letter != letter) ++type;
    return {design_.cells[design_.cell_of_team[row.team()]].series, type};
  }

  static constexpr std::size_t kMax = std::numeric_limits<std::int64_t>::max();

  const RunFiles& run_;
  const ReportDesign& design_;
  const std::function<void(std::string_view)>& on_step_;
  RunData data_;
};

}  // namespace

RunData read_run_data(const RunFiles& run, const ReportDesign& design, std::size_t num_components,
                      const std::function<void(std::string_view)>& on_step) {
  return DataReader{run, design, num_components, on_step}.read();
}

}  // namespace kith::detail
