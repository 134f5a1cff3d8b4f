#include "run_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kith/study/record_columns.hpp"

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
      if (run_.spec().exam == ExamLevel::kPeriod) read_exams();
      if (data_.has_estimates) read_estimates();
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
    data_.has_exam = run_.spec().exam != ExamLevel::kNone;
    data_.leads_with_exam = data_.has_exam && run_.domain.num_features() > 3;
    data_.has_costs = has_costs(run_.study);
    data_.has_forecasts = has_forecasts(run_.study);
    data_.has_estimates = has_estimates(run_.study);
    Names wanted{"completed", "periods", "knowledge", "area_sr", "demonstrations", "tests", "status"};
    const auto costs = wanted.size();
    if (data_.has_costs) wanted.insert(wanted.end(), {"minutes", "person_minutes"});
    const auto exam = wanted.size();
    if (data_.has_exam) wanted.insert(wanted.end(), {"exam_share_right", "exam_regret", "exam_worst_share_right"});
    const auto ahead = wanted.size();
    if (data_.has_forecasts)
      wanted.insert(wanted.end(), {"forecast_periods", "forecast_periods_low", "forecast_periods_high"});
    const bool has_beliefs = has_belief_quality(run_.study);
    const auto particles = wanted.size();
    if (has_beliefs) wanted.emplace_back("fewest_particles");
    const auto rows = read_table("teams.csv", wanted, [&](const auto& row) {
      if (row.team() == last) {
        row.refuse("E0606", "team " + std::to_string(last + 1) + " occurs twice", "remove the second row");
      }
      last = row.team();
      const auto most = max_period(row) * row.address().composition.size();
      auto& team = data_.teams[last];
      team.completed = row.boolean(0);
      team.skipped = row.text(6) == name_of(SessionStatus::kSkipped);
      team.periods = static_cast<double>(row.count(1, 0, most));
      team.replicate = row.address().replicate;
      team.person_periods =
          team.periods *
          (row.address().strategy == kBaseline ? 1.0 : static_cast<double>(row.address().composition.size()));
      team.knowledge = fraction(row, 2);
      team.area_sr = row.real(3);
      team.items = static_cast<double>(row.count(4, 0, kMax) + row.count(5, 0, kMax));
      if (data_.has_costs) {
        team.minutes = row.real(costs);
        team.person_minutes = row.real(costs + 1);
      }
      if (data_.has_exam) {
        team.exam_share_right = fraction(row, exam);
        team.exam_regret = row.real(exam + 1);
        team.exam_worst_share_right = fraction(row, exam + 2);
      }
      if (data_.has_forecasts && row.has(ahead)) {
        team.forecast = TeamValues::Forecast{row.real(ahead), row.real(ahead + 1), row.real(ahead + 2)};
      }
      if (has_beliefs && row.has(particles)) team.fewest_particles = row.real(particles);
    });
    if (rows == num_teams) return;
    refuse_run(ErrorKind::kInvalidInput, "E0606", run_.folder / "tables" / "teams.csv",
               "the table has " + std::to_string(rows) + " teams, the study " + std::to_string(num_teams),
               "restore the table, or run the study again with the same -o");
  }

  void read_periods() {
    data_.components.resize(data_.teams.size() * data_.num_components);
    std::size_t team = kNoTeam, component = 0, last_period = 0;
    Names wanted{"period", "kc", "area_sr", "demonstrations", "tests"};
    if (data_.has_costs) wanted.emplace_back("members");
    if (data_.has_forecasts) wanted.insert(wanted.end(), {"forecast_done_1", "forecast_done_2", "forecast_done_3"});
    const auto mastery = wanted.size();
    if (data_.has_estimates) wanted.insert(wanted.end(), {"p_mastery", "mastery"});
    const bool keeps_costs = run_.spec().exam == ExamLevel::kPeriod;
    if (keeps_costs) costs_.resize(data_.teams.size());
    std::size_t taught = 0;  // periods of the team, over all its sessions
    read_table("periods.csv", wanted, [&](const StudyRow& row) {
      if (row.team() != team) taught = 0;
      ++taught;
      if (keeps_costs) {
        const auto& pace = run_.study.variants[row.address().variant].pace;
        const auto demonstrations = row.count(3, 0, kMax), tests = row.count(4, 0, kMax);
        costs_[row.team()].push_back({static_cast<double>(demonstrations + tests),
                                      minutes_of(pace, demonstrations, tests),
                                      static_cast<double>(row.count(5, 0, row.address().composition.size()))});
      }
      if (data_.has_forecasts && row.has(6)) calibrate(row, taught);
      if (data_.has_estimates && row.has(mastery) && row.has(mastery + 1)) {
        add_mastery(fraction(row, mastery), fraction(row, mastery + 1));
      }
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

  // Compares forecasts after a period with what happened.
  void calibrate(const StudyRow& row, std::size_t taught) {
    const auto& team = data_.teams[row.team()];
    const auto left = static_cast<std::size_t>(team.periods) - std::min(taught, static_cast<std::size_t>(team.periods));
    if (left == 0) return;  // nothing was left to forecast
    for (std::size_t k = 0; k < data_.calibration.size(); ++k) {
      auto& bins = data_.calibration[k];
      const double probability = fraction(row, 6 + k);
      const auto tenth = static_cast<std::size_t>(probability * static_cast<double>(bins.size()));
      auto& bin = bins[std::min(tenth, bins.size() - 1)];
      bin.predicted += probability;
      ++bin.n;
      bin.done += (team.completed || team.skipped) && left <= k + 1 ? 1u : 0u;
    }
  }

  void add_mastery(double predicted, double actual) {
    const auto tenth = static_cast<std::size_t>(predicted * static_cast<double>(data_.mastery.size()));
    auto& bin = data_.mastery[std::min(tenth, data_.mastery.size() - 1)];
    bin.predicted += predicted;
    bin.actual += actual;
    bin.actual_squares += actual * actual;
    ++bin.n;
  }

  void read_estimates() {
    const Names wanted{"period", "kc", "ability", "ability_mean", "ability_low", "ability_high", "proficiency"};
    read_table("estimates.csv", wanted, [&](const StudyRow& row) {
      if (row.has(1) || !row.has(2) || !row.has(3)) return;
      const auto series = design_.cells[design_.cell_of_team[row.team()]].series;
      auto& estimates = data_.ability_estimates[{series, row.count(0, 0, max_period(row))}];
      const double ability = fraction(row, 2);
      estimates.actual.push_back(ability);
      estimates.estimated.push_back(fraction(row, 3));
      estimates.within += ability >= row.real(4) && ability <= row.real(5) ? 1u : 0u;
      const auto& word = row.text(6);
      if (word != "proficient" && word != "not proficient") return;
      const double from = run_.study.variants[row.address().variant].proficient_ability;
      ++estimates.told;
      estimates.told_correctly += (ability >= from) == (word == "proficient") ? 1u : 0u;
    });
  }

  void read_exams() {
    data_.exam_paths.resize(data_.teams.size());
    std::size_t team = kNoTeam;
    std::vector<ExamRow> rows;  // of the team, over all starts
    const auto finish = [&] {
      if (team != kNoTeam) data_.exam_paths[team] = path_of(team, rows);
      rows.clear();
    };
    read_table("exam.csv", {"period", "kc", "member", "share_right", "regret", "p_bec"}, [&](const StudyRow& row) {
      if (row.team() != team) finish();
      team = row.team();
      if (row.has(1) || !row.has(5)) return;
      rows.push_back(
          {row.count(0, 0, max_period(row)), member_of(row, 2), fraction(row, 3), row.real(4), fraction(row, 5)});
    });
    finish();
  }

  struct ExamRow {
    std::size_t period, member;
    double share_right, regret, p_bec;
  };
  struct PeriodCost {
    double items, minutes, members;
  };

  [[nodiscard]] static ExamPoint mean_state(const std::vector<ExamRow>& members, const ExamPoint& cost) {
    auto point = cost;
    point.regret = point.share_right = point.knowledge = 0.0;
    point.worst_share_right = 1.0;
    const auto n = static_cast<double>(members.size());
    for (const auto& one : members) {
      point.regret += one.regret / n;
      point.share_right += one.share_right / n;
      point.knowledge += one.p_bec / n;
      point.worst_share_right = std::min(point.worst_share_right, one.share_right);
    }
    return point;
  }

  // Sessions of a team come one after the other; who is not in a session stays as they are.
  [[nodiscard]] std::vector<ExamPoint> path_of(std::size_t team, const std::vector<ExamRow>& rows) const {
    const auto& costs = costs_[team];
    std::vector<ExamRow> state(run_.teams.addresses[team].composition.size(), ExamRow{});
    for (const auto& row : rows) {
      if (row.period == 0) state[row.member] = row;
    }
    ExamPoint cost;
    for (const auto& one : costs) {
      cost.items -= one.items;
      cost.minutes -= one.minutes;
      cost.person_minutes -= one.minutes * one.members;
    }
    // What was asked before the first period.
    cost.items = std::max(0.0, cost.items + data_.teams[team].items);
    cost.minutes = std::max(0.0, cost.minutes + data_.teams[team].minutes);
    cost.person_minutes = std::max(0.0, cost.person_minutes + data_.teams[team].person_minutes);
    std::vector<ExamPoint> path{mean_state(state, cost)};
    std::size_t taught = 0;
    for (std::size_t i = 0; i < rows.size();) {
      std::size_t end = i;
      for (; end < rows.size() && rows[end].period == rows[i].period; ++end) {
        if (rows[i].period > 0) state[rows[end].member] = rows[end];
      }
      if (rows[i].period > 0 && taught < costs.size()) {
        const auto& one = costs[taught++];
        cost.items += one.items;
        cost.minutes += one.minutes;
        cost.person_minutes += one.minutes * one.members;
        path.push_back(mean_state(state, cost));
      }
      i = end;
    }
    return path;
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
      if (row.has(3)) data_.ability[{series, type, kc, in_component}].push_back(fraction(row, 3));
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

  std::vector<std::vector<PeriodCost>> costs_;  // by team, in the order in which periods were taught

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
