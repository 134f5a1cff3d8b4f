#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/study/group_options.hpp"
#include "kith/teaching/older_robot.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

/// How often people of a mixed type are of another one.
struct LearnerShare {
  char letter = 'N';
  double share = 1.0;
  friend bool operator==(const LearnerShare&, const LearnerShare&) = default;
};

/// A type of simulated learner, named by one letter in compositions.
struct LearnerType {
  char letter = 'N';
  std::string label;  ///< What people of this type are called; may be empty.
  const LearnerModel* model = &bayesian_model();
  ParameterValues parameters{model->parameters};
  std::optional<std::vector<HalfSpace>> prior{};  ///< What this type starts from; none: the domain's prior.
  std::optional<OlderRobot> knowing{};            ///< The robot before an update, which people of this type know.
  /// If not empty, everybody is drawn from these types, which are not mixed themselves, with shares that sum to 1; all
  /// the rest but the label means nothing then.
  std::vector<LearnerShare> mixture{};
};

/// Whether compared strategies teach the same simulated people.
enum class Pairing {
  kReplicate,  ///< Common random numbers: replicate r of a composition is the same people in every strategy.
  kNone,       ///< Fresh people in every cell.
};

/// How much of every team is written down.
enum class RecordLevel {
  kTeam,       ///< Teams and learners.
  kPeriod,     ///< Also periods and responses.
  kParticles,  ///< Also every belief at the end of every period: some 8 000 rows a period for a team of three.
};

/// When simulated people are examined outside the lessons; see Exam.
enum class ExamLevel {
  kNone,
  kEnd,     ///< When teaching has ended.
  kPeriod,  ///< Also after every period.
};

/// One setting of the varied keys of a design, such as {"teacher.process_noise", "0.5"}.
struct FactorSetting {
  std::string key;
  std::string value;
  friend bool operator==(const FactorSetting&, const FactorSetting&) = default;
};

/// A comparison planned beforehand, `[[contrast]]` in study files: a weighted sum of the means of some strategies or
/// compositions.
struct StudyContrast {
  std::string name;
  std::string factor = "strategy";                        ///< Or "composition".
  std::vector<std::pair<std::string, double>> weights{};  ///< Levels, none twice, with weights that sum to 0.
  std::string response{};                                 ///< An outcome, such as "knowledge"; empty: all outcomes.
  bool primary = false;                                   ///< A hypothesis of the study; all others are exploratory.
  friend bool operator==(const StudyContrast&, const StudyContrast&) = default;
};

/// What study files can name. A program that brings kinds of its own lists them here beside the built-in ones; all of
/// them have to stay as long as studies that use them.
struct StudyKinds {
  LearnerModels learners = learner_models();                     ///< `learner.X.kind`; the first is the default.
  std::span<const StrategyKind> strategies = strategy_kinds();   ///< `design.strategies` and `strategy.X.kind`.
  std::span<const AggregationRule> rules = aggregation_rules();  ///< `teacher.beliefs`.
  std::span<const StopRuleKind> stop_rules = stop_rule_kinds();  ///< `stop.mastery` and `stop.release`.
};

/// A study as it will be run: every key of a study file, resolved, for one
/// setting of the varied factors. See docs/study-files.md.
struct StudySpec {
  std::string id;
  std::string title;
  std::string domain = "item-delivery";  ///< Built-in name or path.
  std::size_t num_features = 3;          ///< d of the domain.
  std::int64_t count_scale = 1;          ///< Domain::count_scale(): feature counts are in units of 1 / count_scale.
  RewardWeights weights{};               ///< Of the domain: tables have regrets in the units of its file.
  std::vector<std::string> world_names;  ///< Of every MDP, empty for those without; none if no MDP has a name.
  std::uint64_t seed = 1;
  std::size_t replicates = 15;             ///< Teams per cell, >= 1.
  std::vector<StrategyChoice> strategies;  ///< No two with the same name.
  std::vector<std::string> compositions;   ///< Such as "NNP": 1 to 30 letters of learner types.
  Pairing pairing = Pairing::kReplicate;
  std::vector<LearnerType> learner_types;
  TeachingOptions teaching;
  bool assumes_knowing = true;                ///< Whether the teacher knows which older robot all learners know.
  bool learner_counterfactuals_self = false;  ///< Learners imagine counterfactuals of their own.
  RecordLevel record = RecordLevel::kPeriod;
  ExamLevel exam = ExamLevel::kNone;   ///< Study files of domains with more than three features: kEnd unless they say.
  std::size_t exam_questions = 0;      ///< Questions that everybody answers at the end, as people would.
  std::size_t forecast_sessions = 0;   ///< Imagined sessions of a cell, for forecasts; 0: none are made.
  bool estimates = false;              ///< Whether it is recorded what the teacher's LearnerBank says of people.
  bool beliefs = false;                ///< Whether it is recorded how well particles could represent what was shown.
  double proficient_ability = 0.735;   ///< With estimates: members who learn with at least this ability are proficient.
  std::vector<FactorSetting> factors;  ///< Empty unless the design varies keys.
  std::vector<StudyContrast> contrasts{};  ///< For the analysis; they change nothing in how the study is run.
  bool has_group = false;                  ///< Whether the file has `[group]`.
  GroupOptions group{};                    ///< For sessions with people; changes nothing in how the study is simulated.
};

/// Takes over what a study has to know of its domain.
void take_domain(StudySpec& spec, const Domain& domain);

/// Whether what teaching costs is written down: with exams, and where not everybody is taught all the time.
[[nodiscard]] bool has_costs(const StudySpec& spec) noexcept;

/// The strategy with this name. @throws std::invalid_argument if there is none.
[[nodiscard]] const StrategyChoice& strategy_of(const StudySpec& spec, std::string_view name);

/// The prior of people of a type: their own, or else that of the domain.
[[nodiscard]] Cone prior_of(const LearnerType& type, const Cone& of_domain);
/// What people of a type know of an older robot, within their prior; nothing if they know none.
[[nodiscard]] std::optional<Cone> known_to(const LearnerType& type, const Cone& of_domain);
/// The older robot that people of all types know; nothing if there is none.
[[nodiscard]] std::optional<OlderRobot> known_to_all(const StudySpec& spec);

/// The type with this letter. @throws std::invalid_argument if there is none.
[[nodiscard]] const LearnerType& learner_type(const StudySpec& spec, char letter);

}  // namespace kith
