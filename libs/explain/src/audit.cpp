#include "kith/explain/audit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kith/explain/contrast.hpp"
#include "kith/explain/reason.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

constexpr std::size_t kPeople = 8;  // that a demonstration is judged by

// The feature against which all others are weighed.
std::size_t reference_feature(const Atlas& atlas) {
  const auto& all = atlas.knowledge_components().back().features;
  for (std::size_t k = 0; k < atlas.domain().num_features(); ++k) {
    if (std::find(all.begin(), all.end(), k) == all.end()) return k;
  }
  return 0;
}

bool is_probability(double p) { return p > 0.0 && p < 1.0; }

// The simplest of some starts, those that were not used before first.
class Simplest {
 public:
  explicit Simplest(const Atlas& atlas) : atlas_{atlas} {}

  void offer(StartIndex start, bool is_new, std::size_t besides) {
    const Rank rank{!is_new, besides, atlas_.complexity(start)};
    if (best_ && rank > rank_) return;
    if (best_ && rank == rank_) {
      // Paths are long to find.
      const std::pair ties{length(start), start}, best{length(*best_), *best_};
      if (best <= ties) return;
    }
    rank_ = rank;
    best_ = start;
  }
  [[nodiscard]] std::optional<StartIndex> best() const { return best_; }

 private:
  struct Rank {
    bool is_old = false;
    std::size_t besides = 0;  // other constraints that come with it
    int complexity = 0;
    friend auto operator<=>(const Rank&, const Rank&) = default;
  };
  [[nodiscard]] std::size_t length(StartIndex start) const { return atlas_.trajectory(start).actions.size(); }

  const Atlas& atlas_;
  Rank rank_;  // of best_
  std::optional<StartIndex> best_;
};

}  // namespace

const char* name_of(Understanding understanding) noexcept {
  switch (understanding) {
    case Understanding::kNotTaught:
      return "not-taught";
    case Understanding::kUnderstands:
      return "understands";
    case Understanding::kMisconception:
      return "misconception";
    case Understanding::kCannotTell:
      break;
  }
  return "cannot-tell";
}

Auditor::Auditor(TeachingCache& cache, const AuditOptions& options)
    : cache_{&cache}, options_{options}, unit_{reference_feature(cache.atlas())} {
  const bool is_good = is_probability(options.sure) && is_probability(options.likely) && options.negligible >= 0.0 &&
                       is_probability(options.wrongly) && options.unexplained >= 0.0 && options.unexplained < 1.0 &&
                       options.telling >= 1.0 && options.against_stopping > 0.0 &&
                       options.against_stopping_examined > 0.0 && options.forgetting >= 0.0 &&
                       std::isfinite(options.forgetting);
  if (!is_good) throw std::invalid_argument{"Auditor: an option is out of range"};
  const auto& atlas = cache.atlas();
  for (const auto& component : atlas.knowledge_components()) {
    auto& constraints = constraints_.emplace_back(atlas.constraints().half_spaces(component.constraints));
    std::erase_if(constraints, [&](const HalfSpace& c) { return atlas.prior_cone().implies(c); });
  }
}

std::optional<double> PersonAudit::knowledge() const {
  double sum = 0.0;
  std::size_t taught = 0;
  for (const auto& audit : components) {
    if (audit.understanding == Understanding::kNotTaught) continue;
    sum += audit.level.mean;
    ++taught;
  }
  return taught == 0 ? std::nullopt : std::optional{sum / static_cast<double>(taught)};
}

PersonAudit Auditor::audit(std::span<const ObservedPeriod> periods, const RandomStream& random) {
  return audit(periods, MisconceptionBank::beliefs(*cache_, options_.bank, random.split("bank")), random);
}

std::vector<PersonAudit> Auditor::audit_group(std::span<const std::vector<ObservedPeriod>> people,
                                              const RandomStream& random) {
  std::vector<PersonAudit> audits(people.size());
  std::vector<bool> is_done(people.size(), false);
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (is_done[i]) continue;
    const auto beliefs = MisconceptionBank::beliefs(*cache_, options_.bank, random.split("bank").split(i));
    for (std::size_t j = i; j < people.size(); ++j) {
      const bool shares =
          std::equal(people[i].begin(), people[i].end(), people[j].begin(), people[j].end(), LessonBeliefs::are_same);
      if (is_done[j] || !shares) continue;
      audits[j] = audit(people[j], beliefs, random.split(j));
      is_done[j] = true;
    }
  }
  return audits;
}

PersonAudit Auditor::audit(std::span<const ObservedPeriod> periods, std::shared_ptr<LessonBeliefs> beliefs,
                           const RandomStream& random) {
  MisconceptionBank bank{cache_->atlas(), options_.bank, std::move(beliefs)};
  for (const auto& period : periods) bank.observe(cache_->atlas(), period);
  auto person = judge(bank, periods);
  for (auto& audit : person.components) {
    if (audit.understanding == Understanding::kNotTaught) continue;
    if (person.is_explained) name_misconception(bank, periods, audit);
    audit.test = choose_test(bank, audit, periods);
  }
  if (person.is_explained) plan_tests(bank, random.split("forget"), person.components);
  return person;
}

PersonAudit Auditor::judge(const MisconceptionBank& bank, std::span<const ObservedPeriod> periods) const {
  PersonAudit person;
  person.components.resize(constraints_.size());
  count(periods, person.components);
  person.agreement = bank.agreement();
  person.is_explained = person.agreement.p >= options_.unexplained;
  person.learning = bank.probability_of_learning();
  person.guessing = bank.probability_of_guessing();
  if (person.is_explained && options_.bank.known) person.believes_older = probability_of_older(bank);
  for (auto& audit : person.components) {
    const bool is_judged = audit.periods > 0 || audit.examined > 0;
    if (!person.is_explained) {
      judge_by_answers(audit, is_judged);
      continue;
    }
    audit.level = credible_level(bank.shares(constraints_[audit.component]), options_.level);
    if (!is_judged) continue;
    audit.doubt = doubt(bank, audit);
    audit.understanding = audit.doubt == Doubt::kNone ? Understanding::kUnderstands : Understanding::kCannotTell;
  }
  return person;
}

Doubt Auditor::doubt(const MisconceptionBank& bank, const ComponentAudit& audit) const {
  if (audit.level.probability < options_.sure) return Doubt::kAnswers;
  const bool is_examined = bank.num_boards() > 0;
  const double halves = is_examined ? bank.odds_against_halves() : std::numeric_limits<double>::infinity();
  if (std::min(bank.odds_of_learning(), halves) * options_.wrongly < 1.0) return Doubt::kLearning;
  const double odds = bank.odds_against_stopping(constraints_[audit.component], options_.level);
  return odds < (is_examined ? options_.against_stopping_examined : options_.against_stopping) ? Doubt::kStopping
                                                                                               : Doubt::kNone;
}

void Auditor::name_misconception(const MisconceptionBank& bank, std::span<const ObservedPeriod> periods,
                                 ComponentAudit& audit) {
  audit.misconception = misconception(bank, audit.component, periods);
  const bool is_likely = audit.misconception && audit.misconception->probability >= options_.likely;
  if (audit.understanding == Understanding::kUnderstands || !is_likely) return;
  audit.understanding = Understanding::kMisconception;
  audit.doubt = Doubt::kNone;
  choose_demonstration(bank, audit.component, periods, *audit.misconception);
}

double Auditor::probability_of_older(const MisconceptionBank& bank) const {
  auto both = options_.bank.known->minimal_set();
  const double older = bank.probability_of(both);
  const auto& now = cache_->atlas().policy_bec_half_spaces();
  both.insert(both.end(), now.begin(), now.end());
  return std::max(0.0, older - bank.probability_of(both));
}

// Nothing is known of how these people learn, or of whether they will remember.
void Auditor::judge_by_answers(ComponentAudit& audit, bool is_judged) const {
  audit.level = level_by_answers(audit.correct, audit.tests, options_.level);
  if (!is_judged) return;
  const bool understands = audit.level.probability >= options_.sure;
  audit.understanding = understands ? Understanding::kUnderstands : Understanding::kCannotTell;
  audit.doubt = understands ? Doubt::kNone : Doubt::kAnswers;
  audit.test_after = understands ? 1 : 0;
}

// A board of an exam counts for every component of which it examines a constraint.
void Auditor::count(std::span<const ObservedPeriod> periods, std::vector<ComponentAudit>& audits) const {
  for (std::size_t k = 0; k < audits.size(); ++k) audits[k].component = k;
  for (const auto& period : periods) {
    for (auto& audit : audits) {
      const auto& own = constraints_[audit.component];
      const auto is_own = [&](const HalfSpace& c) { return std::find(own.begin(), own.end(), c) != own.end(); };
      if (period.is_exam()) {
        const auto& examined = period.tests.front().covered;
        if (std::none_of(examined.begin(), examined.end(), is_own)) continue;
        ++audit.examined;
      } else {
        if (period.component != audit.component) continue;
        ++audit.periods;
      }
      for (const auto& verdict : period.verdicts) {
        ++audit.tests;
        audit.correct += verdict.correct ? 1u : 0u;
      }
    }
  }
}

// --- what the person thinks ----------------------------------------------------------------------------------------

std::optional<LikelyMisconception> Auditor::misconception(const MisconceptionBank& bank, std::size_t component,
                                                          std::span<const ObservedPeriod> periods) {
  const HalfSpace* likeliest = nullptr;
  double probability = 0.0;
  for (const auto& constraint : constraints_[component]) {
    const double violated = bank.probability_of_violating(constraint);
    if (violated <= probability) continue;
    probability = violated;
    likeliest = &constraint;
  }
  if (likeliest == nullptr || probability < options_.negligible) return std::nullopt;
  auto misbelief = limited(bank, *likeliest);
  const auto& domain = cache_->atlas().domain();
  auto thinks = in_words(domain, misbelief);
  return LikelyMisconception{.misbelief = std::move(misbelief),
                             .probability = probability,
                             .thinks = std::move(thinks),
                             .fact = in_words(domain, *likeliest),
                             .answers = telling(*likeliest, periods)};
}

// The nearest limit, in whole units, that holds for almost all weights that violate the constraint.
Misbelief Auditor::limited(const MisconceptionBank& bank, const HalfSpace& violated) const {
  constexpr std::int64_t kMostUnits = 8;
  constexpr double kAlmostAll = 0.9;
  Misbelief plain{.violated = violated, .limit = {}, .unit = unit_};
  const auto beyond = violated.opposite();
  const double all = bank.probability_of({&beyond, 1});
  for (std::int64_t n = 1; n <= kMostUnits && all > 0.0; ++n) {
    auto candidate = weakened(cache_->atlas().domain(), violated, unit_, n);
    if (!candidate) break;
    const std::array both{beyond, candidate->satisfied().value()};
    if (bank.probability_of(both) >= kAlmostAll * all) return *candidate;
  }
  return plain;
}

// --- the answers that show it --------------------------------------------------------------------------------------

std::vector<TellingAnswer> Auditor::telling(const HalfSpace& violated, std::span<const ObservedPeriod> periods) {
  std::vector<TellingAnswer> found;
  for (const auto& period : periods) {
    for (std::size_t t = 0; t < period.tests.size() && t < period.answers.size(); ++t) {
      if (!period.answers[t] || period.verdicts[t].correct) continue;
      if (!concerns(violated, cache_->atlas().feature_counts(period.tests[t].start) - *period.answers[t])) continue;
      const auto ratio = factor(violated, period.tests[t], period.answers[t], period.verdicts[t]);
      if (ratio && *ratio < options_.telling) continue;
      found.push_back({.period = period.period,
                       .test = t + 1,
                       .start = period.tests[t].start,
                       .factor = ratio,
                       .text = answer_in_words(period.tests[t], period.answers[t], period.verdicts[t])});
    }
  }
  // The latest count most: what was said before may have been mended.
  if (found.size() > options_.most_answers) {
    found.erase(found.begin(), found.end() - static_cast<std::ptrdiff_t>(options_.most_answers));
  }
  return found;
}

// Whether paths differ in what the constraint weighs against the unit. If they do not, an answer could only tell by
// what is common among people, which convinces nobody.
bool Auditor::concerns(const HalfSpace& constraint, const IntegerVector& difference) const {
  bool weighs_other_things = false;
  for (std::size_t k = 0; k < difference.size(); ++k) {
    if (k == unit_ || constraint.normal()[k] == 0) continue;
    if (difference[k] != 0) return true;
    weighs_other_things = true;
  }
  return !weighs_other_things;
}

std::optional<double> Auditor::factor(const HalfSpace& violated, const Test& test, const Answer& answer,
                                      const Verdict& verdict) {
  const auto& atlas = cache_->atlas();
  if (everybody_.empty()) {
    const auto& cover = cache_->cover(atlas.prior_cone(), options_.bank.filter.particles);
    for (std::size_t i = 0; i < cover.size(); ++i) {
      const auto weights = cover.point(i);
      const auto cell = atlas.find_tables() ? cache_->behaviours().locate(weights) : PolicyCellIndex{0};
      everybody_.push_back({weights, cell});
    }
  }
  std::array<double, 2> people{}, given{};  // who satisfy it, who violate it
  const bool by_path = [&] {
    const auto* tables = atlas.find_tables();
    if (!tables) return false;
    const auto& losses = tables->hull(tables->hull(test.start)).losses;
    return std::find(losses.begin(), losses.end(), atlas.feature_counts(test.start) - *answer) != losses.end();
  }();
  for (const auto& [point, cell] : everybody_) {
    const std::size_t side = violated.contains(point) ? 0 : 1;
    people[side] += 1.0;
    const bool fits = by_path ? cache_->behaviours().answer(test.start, cell) == answer
                              : std::all_of(verdict.half_spaces.begin(), verdict.half_spaces.end(),
                                            [&, &weights = point](const HalfSpace& h) { return h.contains(weights); });
    given[side] += fits ? 1.0 : 0.0;
  }
  if (given[1] == 0.0) return 0.0;
  if (given[0] == 0.0) return std::nullopt;
  return (given[1] / people[1]) / (given[0] / people[0]);
}

std::string Auditor::answer_in_words(const Test& test, const Answer& answer, const Verdict& verdict) const {
  const auto& atlas = cache_->atlas();
  const auto& domain = atlas.domain();
  const auto& robot = atlas.feature_counts(test.start);
  const bool can_be_compared =
      domain.is_exact() && *answer != robot && sign_of_dot(domain.weights().integer, robot - *answer) >= 0;
  if (can_be_compared) return prediction_in_words(domain, *answer, robot);
  std::vector<std::string> shown;
  for (const auto& half_space : verdict.half_spaces) shown.push_back(in_words(domain, half_space));
  return shown.empty() ? "a path that earns less" : "a path that is best if " + listed(shown);
}

// --- what to do next -----------------------------------------------------------------------------------------------

void Auditor::choose_demonstration(const MisconceptionBank& bank, std::size_t component,
                                   std::span<const ObservedPeriod> periods, LikelyMisconception& misconception) {
  const auto& atlas = cache_->atlas();
  auto& behaviours = cache_->behaviours();
  std::vector<StartIndex> shown;
  for (const auto& period : periods) {
    for (const auto& demonstration : period.demonstrations) shown.push_back(demonstration.start);
  }
  std::vector<PolicyCellIndex> people;
  for (const auto& weights : bank.violators(misconception.misbelief.violated, kPeople)) {
    people.push_back(behaviours.locate(weights));
  }
  std::sort(people.begin(), people.end());
  people.erase(std::unique(people.begin(), people.end()), people.end());
  const auto wanted = cache_->numbers_of({&misconception.misbelief.violated, 1}).members().front();
  const auto& lessons = atlas.knowledge_components()[component];
  const auto conveyed = behaviours.conveyed_by_class(lessons, people);
  Simplest simplest{atlas};
  for (const auto c : lessons.start_classes) {
    const auto set = conveyed.set(c);
    if (!set.contains(wanted)) continue;
    for (const auto start : atlas.members(c)) {
      simplest.offer(start, std::find(shown.begin(), shown.end(), start) == shown.end(), set.count());
    }
  }
  misconception.show = simplest.best();
  if (!misconception.show) return;
  const auto contrast = contrast_for(behaviours, *misconception.show, misconception.misbelief.violated, people);
  if (contrast) misconception.reason = reason(atlas, *contrast);
}

std::optional<StartIndex> Auditor::choose_test(const MisconceptionBank& bank, const ComponentAudit& audit,
                                               std::span<const ObservedPeriod> periods) const {
  const auto& atlas = cache_->atlas();
  std::vector<StartIndex> known;
  for (const auto& period : periods) {
    for (const auto& test : period.tests) known.push_back(test.start);
    for (const auto& demonstration : period.demonstrations) known.push_back(demonstration.start);
  }
  const bool is_wrong = audit.understanding == Understanding::kMisconception;
  if (is_wrong && audit.misconception->show) known.push_back(*audit.misconception->show);
  // The constraint that the person gets wrong, then the least certain first.
  std::vector<std::pair<double, HalfSpace>> wanted;
  for (const auto& constraint : constraints_[audit.component]) {
    const bool comes_first = is_wrong && constraint == audit.misconception->misbelief.violated;
    wanted.emplace_back(comes_first ? -1.0 : std::abs(bank.probability_of({&constraint, 1}) - 0.5), constraint);
  }
  std::sort(wanted.begin(), wanted.end());
  for (const auto& [order, constraint] : wanted) {
    const auto number = atlas.constraints().find(constraint);
    if (!number) continue;
    Simplest simplest{atlas};
    for (const auto start : atlas.tests_for(*number)) {
      simplest.offer(start, std::find(known.begin(), known.end(), start) == known.end(),
                     atlas.tested_constraints(start).count());
    }
    if (const auto best = simplest.best()) return best;
  }
  return std::nullopt;
}

void Auditor::plan_tests(const MisconceptionBank& bank, const RandomStream& random,
                         std::vector<ComponentAudit>& audits) const {
  constexpr std::array<std::size_t, 9> kBreaks{1, 2, 3, 4, 6, 8, 12, 16, kLongestBreak};
  if (options_.forgetting == 0.0) return;
  std::vector<std::vector<HalfSpace>> lists;
  std::vector<ComponentAudit*> open;
  for (auto& audit : audits) {
    if (audit.understanding == Understanding::kUnderstands) open.push_back(&audit);
  }
  for (const auto periods : kBreaks) {
    if (open.empty()) return;
    lists.clear();
    for (const auto* audit : open) lists.push_back(constraints_[audit->component]);
    const double angle = options_.forgetting * std::sqrt(static_cast<double>(periods));
    const auto later = bank.shares_after(angle, lists, random.split(periods));
    std::vector<ComponentAudit*> still;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (probability_of_enough(later[i], options_.level) < options_.sure) {
        open[i]->test_after = periods;
      } else {
        still.push_back(open[i]);
      }
    }
    open = std::move(still);
  }
}

}  // namespace kith
