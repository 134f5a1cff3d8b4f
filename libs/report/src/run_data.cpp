#include "run_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kith/study/read_records.hpp"
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
  template <typename Record, typename OnRecord>
  std::size_t read_table(const std::string& table, const std::vector<std::string_view>& wanted, OnRecord on_record) {
    const auto step = "reading " + table;
    on_step_(step);
    const auto text = table_text(run_, table);
    std::size_t rows = 0;
    return read_records<Record>({text, (run_.folder / "tables" / table).string(), &run_.study, run_.teams}, wanted,
                                [&](const RecordRow& row, Record& record) {
                                  if (++rows % kManyRows == 0) on_step_(step);
                                  on_record(row, record);
                                });
  }

  void read_teams() {
    const auto num_teams = run_.teams.size();
    data_.teams.resize(num_teams);
    std::size_t last = kNoTeam;
    data_.has_exam = run_.spec().exam != ExamLevel::kNone;
    data_.leads_with_exam = exam_leads(data_.has_exam, run_.domain.num_features());
    data_.has_costs = has_costs(run_.study);
    data_.has_forecasts = has_forecasts(run_.study);
    data_.has_estimates = has_estimates(run_.study);

    std::vector<std::string_view> wanted{columns::kDemonstrations,
                                         columns::kTests,
                                         columns::kStatus,
                                         columns::kMinutes,
                                         columns::kPersonMinutes,
                                         columns::kForecastPeriods,
                                         columns::kForecastPeriodsLow,
                                         columns::kForecastPeriodsHigh,
                                         columns::kFewestParticles};
    for (const auto& outcome : outcomes()) wanted.push_back(outcome.column);
    const auto rows = read_table<TeamRecord>("teams.csv", wanted, [&](const RecordRow& row, TeamRecord& team) {
      if (row.team == last) {
        row.refuse("E0606", "team " + std::to_string(last + 1) + " occurs twice", "remove the second row");
      }
      last = row.team;
      const auto members = row.address.composition.size();
      static_cast<void>(row.within(team.periods, 0, max_period(row) * members));
      team.cost.person_periods = team.periods * (row.address.strategy == kBaseline ? 1 : members);
      data_.teams[last] = std::move(team);
    });

    if (rows == num_teams) return;
    refuse_run(ErrorKind::kInvalidInput, "E0606", run_.folder / "tables" / "teams.csv",
               "the table has " + std::to_string(rows) + " teams, the study " + std::to_string(num_teams),
               "restore the table, or run the study again with the same -o");
  }

  void read_periods() {
    data_.components.resize(data_.teams.size() * data_.num_components);
    std::size_t team = kNoTeam, component = 0, last_period = 0;
    std::vector<std::string_view> wanted{columns::kPeriod,           columns::kComponent, columns::kAreaSr,
                                         columns::kDemonstrations,   columns::kTests,     columns::kMembers,
                                         columns::kPredictedMastery, columns::kMastery};
    wanted.insert(wanted.end(), std::begin(columns::kForecastDone), std::end(columns::kForecastDone));
    const bool keeps_costs = run_.spec().exam == ExamLevel::kPeriod;
    if (keeps_costs) costs_.resize(data_.teams.size());
    std::size_t taught = 0;  // periods of the team, over all its sessions
    read_table<PeriodRecord>("periods.csv", wanted, [&](const RecordRow& row, const PeriodRecord& period) {
      if (row.team != team) taught = 0;
      ++taught;
      if (keeps_costs) {
        const auto& spec = run_.study.variants[row.address.variant];
        costs_[row.team].push_back({static_cast<double>(period.demonstrations + period.tests),
                                    minutes_of(spec.teaching.pace, period.demonstrations, period.tests,
                                               spec.group.discussion.choice.is_held()),
                                    static_cast<double>(period.members)});
      }
      if (period.forecast) calibrate(row.team, *period.forecast, taught);
      if (period.mastery && period.mastery->actual) add_mastery(period.mastery->predicted, *period.mastery->actual);
      const auto number = row.within(period.period, 1, max_period(row));
      const auto kc = component_of(row, period.component);
      // In the baseline the periods of the next member begin at 1 again.
      const bool first = row.team != team || kc != component || number <= last_period;
      team = row.team;
      component = kc;
      last_period = number;
      auto& values = data_.components[team * data_.num_components + kc];
      ++values.periods;
      if (first) return;
      if (!(period.area_sr > 0.0))
        row.refuse("E0621", "an area must be greater than 0", "restore the table as the run wrote it");
      ++values.later_periods;
      values.log_area_sum += std::log(period.area_sr);
      values.area_sum += period.area_sr;
    });
  }

  // Compares forecasts after a period with what happened.
  void calibrate(std::size_t position, const PeriodForecast& forecast, std::size_t taught) {
    const auto& team = data_.teams[position];
    const auto left = team.periods - std::min(taught, team.periods);
    if (left == 0) return;  // nothing was left to forecast
    for (std::size_t k = 0; k < data_.calibration.size(); ++k) {
      auto& bins = data_.calibration[k];
      const double probability = forecast.done_within[k];
      const auto tenth = static_cast<std::size_t>(probability * static_cast<double>(bins.size()));
      auto& bin = bins[std::min(tenth, bins.size() - 1)];
      bin.predicted += probability;
      ++bin.n;
      bin.done += team.status != SessionStatus::kMaxPeriods && left <= k + 1 ? 1u : 0u;
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
    read_table<EstimateRecord>(
        "estimates.csv",
        {columns::kPeriod, columns::kComponent, columns::kAbility, columns::kAbilityMean, columns::kAbilityLow,
         columns::kAbilityHigh, "p_proficient"},
        [&](const RecordRow& row, const EstimateRecord& estimate) {
          if (estimate.component != 0 || !estimate.ability || !estimate.ability_mean) return;
          const auto series = design_.cells[design_.cell_of_team[row.team]].series;
          auto& estimates = data_.ability_estimates[{series, estimate.period}];
          const double ability = *estimate.ability;
          estimates.actual.push_back(ability);
          estimates.estimated.push_back(*estimate.ability_mean);
          estimates.within += ability >= estimate.ability_low && ability <= estimate.ability_high ? 1u : 0u;
          const auto word = estimate.p_proficient ? proficiency_word(*estimate.p_proficient) : std::string_view{};
          if (word != "proficient" && word != "not proficient") return;
          const double from = run_.study.variants[row.address.variant].proficient_ability;
          ++estimates.told;
          estimates.told_correctly += (ability >= from) == (word == "proficient") ? 1u : 0u;
        });
  }

  void read_exams() {
    data_.exam_paths.resize(data_.teams.size());
    std::size_t team = kNoTeam;
    std::vector<ExamRecord> rows;  // of the team, over all starts
    const auto finish = [&] {
      if (team != kNoTeam) data_.exam_paths[team] = path_of(team, rows);
      rows.clear();
    };
    read_table<ExamRecord>("exam.csv",
                           {columns::kPeriod, columns::kComponent, columns::kMember, columns::kShareRight,
                            columns::kRegret, columns::kBelief},
                           [&](const RecordRow& row, const ExamRecord& exam) {
                             if (row.team != team) finish();
                             team = row.team;
                             if (exam.component == 0 && exam.p_bec) rows.push_back(exam);
                           });
    finish();
  }

  struct PeriodCost {
    double items, minutes, members;
  };

  [[nodiscard]] static ExamPoint mean_state(const std::vector<ExamRecord>& members, const ExamPoint& cost) {
    auto point = cost;
    point.regret = point.share_right = point.knowledge = 0.0;
    point.worst_share_right = 1.0;
    const auto n = static_cast<double>(members.size());
    for (const auto& one : members) {
      point.regret += one.regret / n;
      point.share_right += one.share_right / n;
      point.knowledge += *one.p_bec / n;
      point.worst_share_right = std::min(point.worst_share_right, one.share_right);
    }
    return point;
  }

  // Sessions of a team come one after the other; who is not in a session stays as they are.
  [[nodiscard]] std::vector<ExamPoint> path_of(std::size_t team, const std::vector<ExamRecord>& rows) const {
    const auto& costs = costs_[team];
    std::vector<ExamRecord> state(run_.teams[team].composition.size(), ExamRecord{.p_bec = 0.0});
    for (const auto& row : rows) {
      if (row.period == 0) state[row.member - 1] = row;
    }
    ExamPoint cost;
    for (const auto& one : costs) {
      cost.items -= one.items;
      cost.minutes -= one.minutes;
      cost.person_minutes -= one.minutes * one.members;
    }
    // What was asked before the first period.
    cost.items = std::max(0.0, cost.items + items_of(data_.teams[team]));
    cost.minutes = std::max(0.0, cost.minutes + data_.teams[team].cost.minutes);
    cost.person_minutes = std::max(0.0, cost.person_minutes + data_.teams[team].cost.person_minutes);
    std::vector<ExamPoint> path{mean_state(state, cost)};
    std::size_t taught = 0;
    for (std::size_t i = 0; i < rows.size();) {
      std::size_t end = i;
      for (; end < rows.size() && rows[end].period == rows[i].period; ++end) {
        if (rows[i].period > 0) state[rows[end].member - 1] = rows[end];
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
    std::map<std::pair<std::size_t, std::size_t>, std::pair<PeopleKey, double>> last;  // by team and member
    read_table<ProgressRecord>("progress.csv", {columns::kPeriod, columns::kMember, columns::kBelief},
                               [&](const RecordRow& row, const ProgressRecord& progress) {
                                 const auto period = row.within(progress.period, 1, max_period(row));
                                 const auto member = progress.member - 1;
                                 const auto [series, type] = place(row, member);
                                 data_.knowledge[{series, type, 0, period}].push_back(progress.p_bec);
                                 last[{row.team, member}] = {{series, type, 0, period}, progress.p_bec};
                               });
    for (const auto& [person, value] : last) {
      const auto& [key, known] = value;
      data_.knowledge_at_end[key].push_back(known);
    }
  }

  void read_responses() {
    read_table<ResponseRecord>("responses.csv", {columns::kPeriod, columns::kTest, columns::kMember, columns::kCorrect},
                               [&](const RecordRow& row, const ResponseRecord& response) {
                                 const auto period = row.within(response.period, 1, max_period(row));
                                 const auto [series, type] = place(row, response.member - 1);
                                 auto& values = data_.answers[{series, type, 0, period}];
                                 if (response.test == 1) ++values.people;
                                 ++values.answers;
                                 if (response.correct) ++values.correct;
                               });
  }

  [[nodiscard]] std::size_t max_period(const RecordRow& row) const {
    return run_.study.variants[row.address.variant].teaching.max_periods;
  }
  [[nodiscard]] std::size_t component_of(const RecordRow& row, std::size_t component) const {
    return row.within(component, 1, data_.num_components) - 1;
  }

  struct Place {
    std::size_t series;
    std::size_t type;
  };
  [[nodiscard]] Place place(const RecordRow& row, std::size_t member) const {
    const char letter = row.address.composition[member];
    std::size_t type = 0;
    while (run_.types()[type].letter != letter) ++type;
    return {design_.cells[design_.cell_of_team[row.team]].series, type};
  }

  std::vector<std::vector<PeriodCost>> costs_;  // by team, in the order in which periods were taught

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
