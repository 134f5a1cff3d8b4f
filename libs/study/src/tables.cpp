#include "kith/study/tables.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "kith/table/csv_writer.hpp"
#include "table_columns.hpp"

namespace kith {
namespace {

std::int64_t count(std::size_t n) { return static_cast<std::int64_t>(n); }

std::string blank_separated(const IntegerVector& v) {
  std::string text;
  for (const auto entry : v) text += (text.empty() ? "" : " ") + std::to_string(entry);
  return text;
}

// Counts in units of 1 / scale.
std::string counts_text(const IntegerVector& counts, std::int64_t scale) {
  if (scale == 1) return blank_separated(counts);
  std::string text;
  for (const auto entry : counts) {
    std::array<char, 32> digits{};
    const double value = static_cast<double>(entry) / static_cast<double>(scale);
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text += (text.empty() ? "" : " ") + std::string{digits.data(), end};
  }
  return text;
}

std::string text_of(const std::vector<HalfSpace>& half_spaces) {
  std::string text;
  for (const auto& half_space : half_spaces) text += (text.empty() ? "" : ";") + blank_separated(half_space.normal());
  return text;
}

class Tables {
 public:
  Tables(const Study& study, const TableSink& sink) : study_{study}, has_{optional_columns(study)} {
    for (auto& table : study_tables(study)) {
      if (table.file == "exam.csv") exam_ = writers_.size();
      if (table.file == "estimates.csv") estimates_ = writers_.size();
      writers_.emplace_back(std::move(table.columns),
                            [sink, file = table.file](std::string_view piece) { sink(file, piece); });
    }
  }

  void add(const TeamRecord& team) {
    add_team(team);
    for (const auto& learner : team.learners) add_learner(team, learner);
    for (const auto& period : team.period_records) add_period(team, period);
    for (const auto& response : team.responses) add_response(team, response);
    for (const auto& demonstration : team.demonstration_records) add_demonstration(team, demonstration);
    for (const auto& progress : team.progress) add_progress(team, progress);
    for (const auto& belief : team.beliefs) add_belief(team, belief);
    for (const auto& exam : team.exams) add_exam(team, exam);
    for (const auto& estimate : team.estimates) add_estimate(team, estimate);
  }

  void flush() {
    for (auto& writer : writers_) writer.flush();
  }

 private:
  CsvWriter& begin_row(std::size_t table, const TeamAddress& address) {
    auto& writer = writers_[table];
    writer.text(address.strategy).text(std::string_view{address.composition});
    for (const auto& factor : study_.variants.at(address.variant).factors) writer.text(std::string_view{factor.value});
    return writer.integer(count(address.replicate)).integer(count(address.team));
  }

  void add_team(const TeamRecord& team) {
    auto& row = begin_row(0, team.address);
    row.text(std::string_view{team.seed_address})
        .text(name_of(team.status))
        .boolean(team.completed())
        .integer(count(team.periods))
        .integer(count(team.demonstrations))
        .integer(count(team.tests))
        .real(team.knowledge)
        .real(team.knowledge_min)
        .integer(count(team.components_learned))
        .integer(count(team.components_skipped))
        .real(team.area_sr);
    if (has_.costs) {
      row.integer(count(team.cost.person_periods)).real(team.cost.minutes).real(team.cost.person_minutes);
    }
    if (has_.forecasts) add_forecast(row, team.forecast);
    if (has_.beliefs) row.real(team.fewest_particles);
    if (team.exam) {
      row.real(team.exam->share_right).real(team.exam->regret).real(team.exam->worst_share_right);
    }
    row.end_row();
  }

  static void add_forecast(CsvWriter& row, const std::optional<TeamForecast>& forecast) {
    for (const auto value : {&TeamForecast::periods, &TeamForecast::periods_low, &TeamForecast::periods_high,
                             &TeamForecast::minutes, &TeamForecast::minutes_low, &TeamForecast::minutes_high}) {
      row.real(forecast ? std::optional{(*forecast).*value} : std::nullopt);
    }
  }

  void add_learner(const TeamRecord& team, const LearnerRecord& learner) {
    auto& row = begin_row(1, team.address).integer(count(learner.member)).text(std::string_view{&learner.type, 1});
    const auto& traits = learner_type(study_.variants.at(team.address.variant), learner.type).model->traits;
    for (const auto& name : has_.traits) row.real(trait(name, traits, learner.traits));
    row.real(learner.p_bec)
        .integer(count(learner.periods))
        .integer(count(learner.tests))
        .integer(count(learner.correct));
    if (team.exam) {
      row.real(learner.exam_share_right)
          .real(learner.exam_regret)
          .integer(count(learner.exam_questions))
          .integer(count(learner.exam_correct));
    }
    row.end_row();
  }

  [[nodiscard]] static std::optional<double> trait(const std::string& name, std::span<const LearnerTrait> traits,
                                                   const std::vector<double>& values) {
    const auto found = std::find_if(traits.begin(), traits.end(), [&](const auto& one) { return one.name == name; });
    if (found == traits.end()) return std::nullopt;
    return values.at(static_cast<std::size_t>(found - traits.begin()));
  }

  void add_period(const TeamRecord& team, const PeriodRecord& period) {
    auto& writer = begin_row(2, team.address);
    if (has_.subgroups) writer.integer(count(period.session));
    writer.integer(count(period.period))
        .integer(count(period.component))
        .text(std::string_view{period.source})
        .integer(count(period.demonstrations))
        .real(period.area_sr)
        .real(period.running_area_sr)
        .integer(count(period.tests))
        .boolean(period.all_correct)
        .integer(count(period.excluded))
        .integer(count(period.untested))
        .real(period.gain);
    if (has_.costs) writer.integer(count(period.members));
    if (has_.forecasts) {
      const auto& ahead = period.forecast;
      writer.real(ahead ? std::optional{ahead->periods_left} : std::nullopt);
      for (std::size_t k = 0; k < 3; ++k) writer.real(ahead ? std::optional{ahead->done_within.at(k)} : std::nullopt);
    }
    if (has_.estimates) {
      writer.real(period.mastery ? std::optional{period.mastery->predicted} : std::nullopt);
      writer.real(period.mastery ? period.mastery->actual : std::nullopt);
    }
    for (const double p_bec : period.p_bec) writer.real(p_bec);
    writer.end_row();
  }

  void add_response(const TeamRecord& team, const ResponseRecord& response) {
    const auto answer = response.answer
                            ? std::optional{counts_text(*response.answer, study_.variants.front().count_scale)}
                            : std::nullopt;
    begin_row(3, team.address)
        .integer(count(response.period))
        .integer(count(response.component))
        .integer(count(response.test))
        .integer(count(response.member))
        .integer(count(response.mdp))
        .integer(count(response.start))
        .boolean(response.correct)
        .real(response.regret)
        .text_or_missing(answer)
        .text(std::string_view{text_of(response.constraints)})
        .text(std::string_view{text_of(response.covered)})
        .end_row();
  }

  void add_demonstration(const TeamRecord& team, const DemonstrationRecord& shown) {
    begin_row(4, team.address)
        .integer(count(shown.period))
        .integer(shown.member == 0 ? std::nullopt : std::optional{count(shown.member)})
        .integer(count(shown.component))
        .integer(count(shown.demonstration))
        .integer(count(shown.mdp))
        .integer(count(shown.start))
        .text(std::string_view{text_of(shown.constraints)})
        .end_row();
  }

  void add_progress(const TeamRecord& team, const ProgressRecord& progress) {
    begin_row(5, team.address)
        .integer(count(progress.period))
        .integer(count(progress.component))
        .integer(count(progress.member))
        .text(std::string_view{&progress.type, 1})
        .real(progress.ability)
        .real(progress.p_bec)
        .boolean(progress.all_correct)
        .end_row();
  }

  void add_belief(const TeamRecord& team, const BeliefSnapshot& belief) {
    for (std::size_t i = 0; i < belief.weights.size(); ++i) {
      auto& row = begin_row(6, team.address)
                      .integer(count(belief.period))
                      .text(std::string_view{belief.belief})
                      .integer(count(i + 1));
      for (std::size_t at = i; at < belief.points.size(); at += belief.weights.size()) row.real(belief.points[at]);
      row.real(belief.weights[i]).end_row();
    }
  }

  // Of what is about a member: over all components if the record's component is 0.
  template <typename Record>
  CsvWriter& begin_member_row(std::size_t table, const TeamAddress& address, const Record& record) {
    return begin_row(table, address)
        .integer(count(record.period))
        .integer(record.component == 0 ? std::nullopt : std::optional{count(record.component)})
        .integer(count(record.member))
        .text(std::string_view{&record.type, 1});
  }

  void add_exam(const TeamRecord& team, const ExamRecord& exam) {
    begin_member_row(exam_, team.address, exam).real(exam.share_right).real(exam.regret).real(exam.p_bec).end_row();
  }

  void add_estimate(const TeamRecord& team, const EstimateRecord& estimate) {
    const auto word =
        estimate.p_proficient ? std::optional{std::string{proficiency_word(*estimate.p_proficient)}} : std::nullopt;
    begin_member_row(estimates_, team.address, estimate)
        .real(estimate.ability)
        .real(estimate.ability_mean)
        .real(estimate.ability_low)
        .real(estimate.ability_high)
        .real(estimate.p_proficient)
        .text_or_missing(word)
        .real(estimate.p_knew)
        .real(estimate.knew)
        .real(estimate.p_right)
        .real(estimate.right)
        .end_row();
  }

  const Study& study_;
  OptionalColumns has_;
  std::vector<CsvWriter> writers_;        // in the order of study_tables()
  std::size_t exam_ = 0, estimates_ = 0;  // positions of tables that are not always there
};

}  // namespace

void write_study_tables(const Study& study, std::span<const TeamRecord> teams, const TableSink& sink) {
  write_study_tables(
      study,
      [&](const std::function<void(const TeamRecord& team)>& visit) {
        for (const auto& team : teams) visit(team);
      },
      sink);
}

void write_study_tables(const Study& study, const TeamSource& teams, const TableSink& sink) {
  Tables tables{study, sink};
  teams([&](const TeamRecord& team) { tables.add(team); });
  tables.flush();
}

}  // namespace kith
