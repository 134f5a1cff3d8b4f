#include "kith/teaching/session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kith/bec/comparison.hpp"
#include "kith/teaching/test_selection.hpp"

namespace kith {
namespace {

constexpr std::size_t kMaxMembers = 30;

void require(bool holds, const std::string& rule) {
  if (!holds) throw std::invalid_argument{"Session: " + rule};
}

// Returns that differ by less than this, relative to the robot's, are equal where they are expectations.
constexpr double kReturnTolerance = 1e-6;

TeamBelief::Options belief_options(const TeachingOptions& options, Strategy strategy, std::size_t dimension) {
  auto parts = entry_of(strategy).reads;
  parts.members = parts.members || options.also_record.members;
  parts.common = parts.common || options.also_record.common;
  parts.joint = parts.joint || options.also_record.joint;
  return {.filter = options.filter,
          .likelihood = HalfSpaceLikelihood{options.assumed_ability, options.likelihood, dimension},
          .response_noise = options.response_noise,
          .reduce_before_update = options.reduce_before_update,
          .parts = parts};
}

}  // namespace

Session::Session(const Atlas& atlas, TeachingCache& cache, const TeachingOptions& options, Strategy strategy,
                 std::vector<RandomStream> persons, RandomStream teacher)
    : atlas_{&atlas},
      cache_{&cache},
      options_{options},
      strategy_{strategy},
      persons_{std::move(persons)},
      teacher_{teacher},
      belief_{cache.cover(atlas.prior_cone(), options.filter.particles),
              belief_options(options, strategy, atlas.domain().num_features()), persons_, teacher.split("team belief")},
      components_(atlas.knowledge_components().size(), ComponentStatus::kOpen),
      visited_{atlas.num_demos()},
      taught_before_{cache.regions().minimal(atlas.prior())},
      taught_with_unit_{taught_before_} {
  require(persons_.size() <= kMaxMembers, "a team has at most 30 members");
  require(strategy_ != Strategy::kBaseline || persons_.size() == 1, "the baseline teaches one person per session");
  require(options.counterfactuals >= 1, "counterfactuals must be at least 1");
  require(options.max_periods >= 1, "max_periods must be at least 1");
  require(options.consecutive_correct >= 1, "consecutive_correct must be at least 1");
  require(options.duplicate_sets >= 1, "duplicate_sets must be at least 1");
  for (const auto& person : persons_) tie_breaks_.push_back(person.address());
  prepare_lesson();
}

const Lesson& Session::lesson() const {
  if (finished()) throw std::logic_error{"Session::lesson: the session is finished"};
  return lesson_;
}

// The next lesson of the current component, or of the first later one that has anything to teach.
void Session::prepare_lesson() {
  lesson_ = Lesson{};
  lesson_.period = periods_ + 1;
  for (; component_ < components_.size(); ++component_) {
    const auto random = teacher_.split("lesson").split(periods_).split(component_);
    lesson_.component = component_;
    lesson_.source = choose_source();
    auto unit = choose_unit(lesson_.source, random.split("demonstrations"));
    if (unit) {
      lesson_.demonstrations = std::move(unit->demonstrations);
      lesson_.counterfactuals = std::move(unit->counterfactuals);
      describe_lesson(unit->taught_region);
    } else if (last_of_component_) {
      const auto period = lesson_.period;
      const auto source = lesson_.source;
      lesson_ = *last_of_component_;
      lesson_.period = period;
      lesson_.source = source;
      lesson_.repeats = true;
      lesson_.gain = 0.0;
    } else {
      components_[component_] = ComponentStatus::kSkipped;
      continue;
    }
    choose_tests(random.split("tests"));
    return;
  }
  status_ = SessionStatus::kComplete;
}

// Demonstrations not shown before; if none has gain and the component is under way, any.
std::optional<Unit> Session::choose_unit(SourceBelief source, const RandomStream& random) {
  const auto& component = atlas_->knowledge_components()[component_];
  const SelectionOptions selection{.counterfactuals = options_.counterfactuals,
                                   .sampling = options_.sampling,
                                   .likelihood = belief_.options().likelihood};
  auto unit = select_demonstrations(*atlas_, *cache_, belief_of(source), component, taught_before_, visited_, selection,
                                    random.split("new"));
  if (unit.demonstrations.empty() && last_of_component_) {
    VisitedDemos nothing_visited{atlas_->num_demos()};
    unit = select_demonstrations(*atlas_, *cache_, belief_of(source), component, taught_before_, nothing_visited,
                                 selection, random.split("again"));
    for (const auto& chosen : unit.demonstrations) visited_.insert(chosen.demo);
  }
  if (unit.demonstrations.empty()) return std::nullopt;
  return unit;
}

SourceBelief Session::choose_source() const {
  const auto& entry = entry_of(strategy_);
  std::vector<double> knowledge;
  if (entry.reads.members) {
    // The region of the component as last taught; before its first unit, the policy's.
    auto region = last_of_component_ ? last_of_component_->taught : atlas_->policy_bec_half_spaces();
    for (std::size_t i = 0; i < persons_.size(); ++i) knowledge.push_back(belief_.member(i).mass_in(region));
  }
  return entry.choose({knowledge, tie_breaks_});
}

const ParticleBelief& Session::belief_of(SourceBelief source) const {
  switch (source.kind) {
    case SourceBelief::Kind::kMember:
      return belief_.member(source.member);
    case SourceBelief::Kind::kCommon:
      return belief_.common();
    case SourceBelief::Kind::kJoint:
      return belief_.joint();
  }
  throw std::logic_error{"Session: unknown source"};
}

void Session::describe_lesson(const ConstraintSet& taught_region) {
  auto conveyed = atlas_->prior();
  for (const auto& shown : lesson_.demonstrations) conveyed |= shown.constraints;
  const auto& region = cache_->regions().of(conveyed);
  lesson_.taught = cache_->constraints().half_spaces(region.minimal.without(atlas_->prior()));
  lesson_.area_sr = region.area_sr;
  lesson_.running_area_sr = cache_->regions().of(taught_region).area_sr;
  lesson_.gain = std::log(cache_->regions().of(taught_before_).area_sr / lesson_.running_area_sr);
  taught_with_unit_ = taught_region;
}

void Session::choose_tests(const RandomStream& random) {
  const auto& component = atlas_->knowledge_components()[component_];
  lesson_.tests.clear();
  for (std::size_t set = 0; set < options_.duplicate_sets; ++set) {
    auto choice = select_tests(*atlas_, component, lesson_.demonstrations, lesson_.taught, visited_, random.split(set));
    lesson_.untested = choice.untested;
    lesson_.tests.insert(lesson_.tests.end(), choice.tests.begin(), choice.tests.end());
  }
}

Verdict Session::judge(const Test& test, const Answer& answer) const {
  Verdict verdict;
  verdict.answered = answer.has_value();
  if (!answer) return verdict;
  const auto& domain = atlas_->domain();
  const auto scale = static_cast<double>(domain.count_scale());
  const auto& robot = atlas_->feature_counts(test.demo);
  const auto loss = robot - *answer;
  const double regret = domain.weights().return_of(loss) / scale;
  const double tolerance =
      domain.is_exact() ? 0.0 : kReturnTolerance * std::max(1.0, std::abs(domain.weights().return_of(robot)) / scale);
  const int sign = std::abs(regret) <= tolerance ? 0 : sign_of_dot(domain.weights().integer, loss);
  if (sign < 0) throw std::invalid_argument{"Session::submit: an answer earns more than the robot's optimal behaviour"};
  verdict.correct = sign == 0;
  verdict.regret = verdict.correct ? 0.0 : regret;
  if (verdict.correct) {
    verdict.half_spaces = test.covered;
  } else if (auto preferred = preference(-loss, domain.count_scale())) {
    verdict.half_spaces.push_back(std::move(*preferred));
  }
  return verdict;
}

Feedback Session::submit(std::span<const std::vector<Answer>> answers) {
  if (finished()) throw std::logic_error{"Session::submit: the session is finished"};
  require(answers.size() == persons_.size(), "submit needs one list of answers per member");
  for (const auto& list : answers) require(list.size() == lesson_.tests.size(), "submit needs one answer per test");

  Feedback feedback;
  std::vector<std::vector<HalfSpace>> shown(persons_.size());
  for (std::size_t i = 0; i < persons_.size(); ++i) {
    auto& verdicts = feedback.verdicts.emplace_back();
    for (std::size_t t = 0; t < lesson_.tests.size(); ++t) {
      verdicts.push_back(judge(lesson_.tests[t], answers[i][t]));
      shown[i].insert(shown[i].end(), verdicts.back().half_spaces.begin(), verdicts.back().half_spaces.end());
    }
    feedback.all_correct.push_back(
        std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.correct; }));
  }
  for (const auto& test : lesson_.tests) {
    feedback.half_spaces.insert(feedback.half_spaces.end(), test.covered.begin(), test.covered.end());
  }

  std::vector<HalfSpace> conveyed;
  for (const auto& demo : lesson_.demonstrations)
    conveyed.insert(conveyed.end(), demo.half_spaces.begin(), demo.half_spaces.end());
  belief_.observe_demonstrations(conveyed, lesson_.period);
  feedback.excluded = belief_.observe_responses(shown, lesson_.period);
  belief_.observe_feedback(feedback.half_spaces, lesson_.period);

  const bool everybody =
      std::all_of(feedback.all_correct.begin(), feedback.all_correct.end(), [](bool correct) { return correct; });
  const auto component = component_;
  conclude_period(everybody);
  feedback.component_learned = components_[component] == ComponentStatus::kLearned;
  return feedback;
}

void Session::conclude_period(bool all_correct) {
  ++periods_;
  correct_in_a_row_ = all_correct ? correct_in_a_row_ + 1 : 0;
  last_of_component_ = std::move(lesson_);
  if (correct_in_a_row_ >= options_.consecutive_correct) {
    components_[component_] = ComponentStatus::kLearned;
    taught_before_ = taught_with_unit_;
    last_of_component_.reset();
    correct_in_a_row_ = 0;
    ++component_;
  }
  const bool more = std::any_of(components_.begin(), components_.end(),
                                [](ComponentStatus status) { return status == ComponentStatus::kOpen; });
  if (more && periods_ >= options_.max_periods) {
    status_ = SessionStatus::kMaxPeriods;
    lesson_ = Lesson{};
    return;
  }
  prepare_lesson();
}

}  // namespace kith
