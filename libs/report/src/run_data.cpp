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

    const Names wanted{columns::kCompleted,
                       columns::kPeriods,
                       columns::kKnowledge,
                       columns::kAreaSr,
                       columns::kDemonstrations,
                       columns::kTests,
                       columns::kStatus,
                       columns::kMinutes,
                       columns::kPersonMinutes,
                       columns::kExamShareRight,
                       columns::kExamRegret,
                       columns::kExamWorstShareRight,
                       columns::kForecastPeriods,
                       columns::kForecastPeriodsLow,
                       columns::kForecastPeriodsHigh,
                       columns::kFewestParticles};

    const auto rows = read_table("teams.csv", wanted, [&](const auto& row) {
      if (row.team() == last) {
        row.refuse("E0606", "team " + std::to_string(last + 1) + " occurs twice", "remove the second row");
      }
      last = row.team();

      const auto most = max_period(row) * row.address().composition.size();
      auto& team = data_.teams[last];
      team.completed = row.boolean(columns::kCompleted);
      team.skipped = row.text(columns::kStatus) == name_of(SessionStatus::kSkipped);
      team.periods = static_cast<double>(row.count(columns::kPeriods, 0, most));
      team.replicate = row.address().replicate;
      team.person_periods =
          team.periods *
          (row.address().strategy == kBaseline ? 1.0 : static_cast<double>(row.address().composition.size()));
      team.knowledge = fraction(row, columns::kKnowledge);
      team.area_sr = row.real(columns::kAreaSr);
      team.items =
          static_cast<double>(row.count(columns::kDemonstrations, 0, kMax) + row.count(columns::kTests, 0, kMax));

      // What the study did not measure has no columns.
      if (data_.has_costs) {
        team.minutes = row.real(columns::kMinutes);
        team.person_minutes = row.real(columns::kPersonMinutes);
      }
      if (data_.has_exam) {
        team.exam_share_right = fraction(row, columns::kExamShareRight);
        team.exam_regret = row.real(columns::kExamRegret);
        team.exam_worst_share_right = fraction(row, columns::kExamWorstShareRight);
      }
      if (row.has(columns::kForecastPeriods)) {
        team.forecast =
            TeamValues::Forecast{row.real(columns::kForecastPeriods), row.real(columns::kForecastPeriodsLow),
                                 row.real(columns::kForecastPeriodsHigh)};
      }
      if (row.has(columns::kFewestParticles)) team.fewest_particles = row.real(columns::kFewestParticles);
    });

    if (rows == num_teams) return;
    refuse_run(ErrorKind::kInvalidInput, "E0606", run_.folder / "tables" / "teams.csv",
               "the table has " + std::to_string(rows) + " teams, the study " + std::to_string(num_teams),
               "restore the table, or run the study again with the same -o");
  }

  void read_periods() {
    data_.components.resize(data_.teams.size() * data_.num_components);
    std::size_t team = kNoTeam, component = 0, last_period = 0;
    Names wanted{columns::kPeriod, columns::kComponent, columns::kAreaSr,           columns::kDemonstrations,
                 columns::kTests,  columns::kMembers,   columns::kPredictedMastery, columns::kMastery};
    wanted.insert(wanted.end(), std::begin(columns::kForecastDone), std::end(columns::kForecastDone));
    const bool keeps_costs = run_.spec().exam == ExamLevel::kPeriod;
    if (keeps_costs) costs_.resize(data_.teams.size());
    std::size_t taught = 0;  // periods of the team, over all its sessions
    read_table("periods.csv", wanted, [&](const StudyRow& row) {
      if (row.team() != team) taught = 0;
      ++taught;
      if (keeps_costs) {
        const auto& spec = run_.study.variants[row.address().variant];
        const auto demonstrations = row.count(columns::kDemonstrations, 0, kMax),
                   tests = row.count(columns::kTests, 0, kMax);
        costs_[row.team()].push_back(
            {static_cast<double>(demonstrations + tests),
             minutes_of(spec.teaching.pace, demonstrations, tests, spec.group.discussion.choice.is_held()),
             static_cast<double>(row.count(columns::kMembers, 0, row.address().composition.size()))});
      }
      if (row.has(columns::kForecastDone[0])) calibrate(row, taught);
      if (row.has(columns::kPredictedMastery) && row.has(columns::kMastery)) {
        add_mastery(fraction(row, columns::kPredictedMastery), fraction(row, columns::kMastery));
      }
      const auto period = period_of(row);
      const auto kc = component_of(row);
      // In the baseline the periods of the next member begin at 1 again.
      const bool first = row.team() != team || kc != component || period <= last_period;
      team = row.team();
      component = kc;
      last_period = period;
      auto& values = data_.components[team * data_.num_components + kc];
      ++values.periods;
      if (first) return;
      const double area = row.real(columns::kAreaSr);
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
      const double probability = fraction(row, columns::kForecastDone[k]);
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
    const Names wanted{columns::kPeriod,     columns::kComponent,   columns::kAbility,    columns::kAbilityMean,
                       columns::kAbilityLow, columns::kAbilityHigh, columns::kProficiency};
    read_table("estimates.csv", wanted, [&](const StudyRow& row) {
      if (row.has(columns::kComponent) || !row.has(columns::kAbility) || !row.has(columns::kAbilityMean)) return;
      const auto series = design_.cells[design_.cell_of_team[row.team()]].series;
      auto& estimates = data_.ability_estimates[{series, row.count(columns::kPeriod, 0, max_period(row))}];
      const double ability = fraction(row, columns::kAbility);
      estimates.actual.push_back(ability);
      estimates.estimated.push_back(fraction(row, columns::kAbilityMean));
      estimates.within +=
          ability >= row.real(columns::kAbilityLow) && ability <= row.real(columns::kAbilityHigh) ? 1u : 0u;
      const auto& word = row.text(columns::kProficiency);
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
    read_table("exam.csv",
               {columns::kPeriod, columns::kComponent, columns::kMember, columns::kShareRight, columns::kRegret,
                columns::kBelief},
               [&](const StudyRow& row) {
                 if (row.team() != team) finish();
                 team = row.team();
                 if (row.has(columns::kComponent) || !row.has(columns::kBelief)) return;
                 rows.push_back({row.count(columns::kPeriod, 0, max_period(row)), member_of(row),
                                 fraction(row, columns::kShareRight), row.real(columns::kRegret),
                                 fraction(row, columns::kBelief)});
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
    std::map<std::pair<std::size_t, std::size_t>, std::pair<PeopleKey, double>> last;  // by team and member
    read_table("progress.csv",
               {columns::kPeriod, columns::kComponent, columns::kMember, columns::kAbility, columns::kBelief},
               [&](const StudyRow& row) {
                 if (row.team() != team) seen.assign(row.address().composition.size() * data_.num_components, 0);
                 team = row.team();
                 const auto period = period_of(row);
                 const auto kc = component_of(row);
                 const auto member = member_of(row);
                 const auto [series, type] = place(row, member);
                 const auto in_component = ++seen[member * data_.num_components + kc];
                 if (row.has(columns::kAbility))
                   data_.ability[{series, type, kc, in_component}].push_back(fraction(row, columns::kAbility));
                 const double known = fraction(row, columns::kBelief);
                 data_.knowledge[{series, type, 0, period}].push_back(known);
                 last[{team, member}] = {{series, type, 0, period}, known};
               });
    for (const auto& [person, value] : last) {
      const auto& [key, known] = value;
      data_.knowledge_at_end[key].push_back(known);
    }
  }

  void read_responses() {
    read_table("responses.csv", {columns::kPeriod, columns::kTest, columns::kMember, columns::kCorrect},
               [&](const StudyRow& row) {
                 const auto period = period_of(row);
                 const auto [series, type] = place(row, member_of(row));
                 auto& values = data_.answers[{series, type, 0, period}];
                 if (row.count(columns::kTest, 1, kMax) == 1) ++values.people;
                 ++values.answers;
                 if (row.boolean(columns::kCorrect)) ++values.correct;
               });
  }

  [[nodiscard]] std::size_t max_period(const StudyRow& row) const {
    return run_.study.variants[row.address().variant].teaching.max_periods;
  }
  [[nodiscard]] std::size_t period_of(const StudyRow& row) const {
    return row.count(columns::kPeriod, 1, max_period(row));
  }
  [[nodiscard]] std::size_t component_of(const StudyRow& row) const {
    return row.count(columns::kComponent, 1, data_.num_components) - 1;
  }
  [[nodiscard]] static std::size_t member_of(const StudyRow& row) {
    return row.count(columns::kMember, 1, row.address().composition.size()) - 1;
  }
  [[nodiscard]] static double fraction(const StudyRow& row, std::string_view column) {
    const double value = row.real(column);
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
