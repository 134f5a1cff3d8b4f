#include "team_estimates.hpp"

#include <algorithm>
#include <utility>

#include "kith/teaching/known_components.hpp"
#include "kith/teaching/random_test.hpp"

namespace kith {
namespace {

constexpr double kInterval = 0.8;

RandomTest random_test(TeachingCache& cache, std::size_t component) { return {cache.atlas(), cache.exam(), component}; }

// Nothing if the answers of the person do not come from a belief.
std::optional<std::vector<double>> right_answers(const RandomTest& test, const Learner& learner) {
  if (learner.answers_as_believed()) return test.right(*learner.belief());
  return std::nullopt;
}

double mean_right(const RandomTest& test, std::vector<double> right) {
  const std::vector<std::vector<double>> alone{std::move(right)};
  return test.all_right(alone);
}

}  // namespace

std::string_view proficiency_word(double p_proficient) noexcept {
  constexpr double kSure = 0.8;
  if (p_proficient >= kSure) return "proficient";
  if (p_proficient <= 1.0 - kSure) return "not proficient";
  return "cannot tell yet";
}

void TeamEstimates::at_start(const Session& session, const Learners& learners, const std::vector<LearnerRecord>& rows) {
  if (!is_asked()) return;
  const auto components = constraints_of_components(cache_.atlas());
  for (const auto& learner : learners) {
    auto& masses = knew_.emplace_back();
    for (const auto& half_spaces : components) masses.push_back(learner->mass_in(half_spaces));
  }
  if (spec_.record != RecordLevel::kTeam) write(session, learners, rows);
}

void TeamEstimates::after_period(const Session& session, const Learners& learners,
                                 const std::vector<LearnerRecord>& rows) {
  if (is_asked() && spec_.record != RecordLevel::kTeam) write(session, learners, rows);
}

void TeamEstimates::at_end(const Session& session, const Learners& learners, const std::vector<LearnerRecord>& rows) {
  if (is_asked() && spec_.record == RecordLevel::kTeam) write(session, learners, rows);
}

void TeamEstimates::write(const Session& session, const Learners& learners, const std::vector<LearnerRecord>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EstimateRecord record;
    record.period = session.periods();
    record.member = rows[i].member;
    record.type = rows[i].type;
    auto bank = session.bank()->member(i);  // a copy, for what it caches
    write_person(record, bank, *learners[i]);
    write_components(record, bank, *learners[i], i);
  }
}

void TeamEstimates::write_person(EstimateRecord record, const LearnerBank& bank, const Learner& learner) {
  if (const auto abilities = learner.learning_abilities(true)) record.ability = abilities->shown;
  if (spec_.teaching.hypotheses_about == HypothesesAbout::kAbility) {
    record.ability_mean = bank.expected_ability();
    record.ability_low = bank.ability_quantile((1.0 - kInterval) / 2.0);
    record.ability_high = bank.ability_quantile((1.0 + kInterval) / 2.0);
    record.p_proficient = bank.probability_of_ability(spec_.proficient_ability);
  }
  if (spec_.teaching.hypotheses_about == HypothesesAbout::kKinds) {
    const auto kinds = bank.kinds();
    for (const auto& one : kinds) record.p_kinds.push_back(one.probability);
    record.kind = kind_word(kinds);
  }
  record_.estimates.push_back(record);
}

void TeamEstimates::write_components(const EstimateRecord& record, LearnerBank& bank, const Learner& learner,
                                     std::size_t member) {
  const auto& known = knew_[member];
  const bool asks_what_is_known = spec_.teaching.hypotheses_about == HypothesesAbout::kKnownComponents;
  for (std::size_t k = 0; k < known.size(); ++k) {
    const auto test = random_test(cache_, k);
    auto row = record;
    row.component = k + 1;
    if (asks_what_is_known && k < num_known_by_chance(known.size())) {
      row.p_knew = bank.probability_of_knowing(k);
      row.knew = known[k];
    }
    row.p_right = mean_right(test, test.right(bank));
    if (auto right = right_answers(test, learner)) row.right = mean_right(test, *std::move(right));
    record_.estimates.push_back(row);
  }
}

std::optional<PeriodMastery> mastery_after(TeachingCache& cache, const StudySpec& spec, const Session& session,
                                           const Learners& learners, std::span<const std::size_t> present) {
  if (!spec.estimates) return std::nullopt;
  const auto test = random_test(cache, session.history().back().lesson.component);
  std::vector<std::vector<double>> predicted, actual;
  for (const auto i : present) {
    auto bank = session.bank()->member(i);
    predicted.push_back(test.right(bank));
    if (auto right = right_answers(test, *learners[i])) actual.push_back(*std::move(right));
  }
  PeriodMastery mastery{test.all_right(predicted), std::nullopt};
  if (actual.size() == present.size()) mastery.actual = test.all_right(actual);
  return mastery;
}

}  // namespace kith
