#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/explain/misconception.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/credible_level.hpp"
#include "kith/teaching/misconception_bank.hpp"
#include "kith/teaching/observed_period.hpp"

namespace kith {

/// What can be said of a person and a component.
enum class Understanding {
  kNotTaught,      ///< The person has had no lesson about it, and was not examined.
  kUnderstands,    ///< Almost certainly satisfies all its constraints often enough.
  kCannotTell,     ///< Neither of the others.
  kMisconception,  ///< More likely than not violates one of its constraints.
};

/// "not-taught", "understands", "cannot-tell" or "misconception".
[[nodiscard]] const char* name_of(Understanding understanding) noexcept;

/// Why nothing more can be said than Understanding::kCannotTell.
enum class Doubt {
  kNone,      ///< More can be said.
  kAnswers,   ///< Too few answers, or too many wrong ones: it is not probable enough that the person understands.
  kLearning,  ///< People who guess, or whom no lesson ever reaches, give such answers too often.
  kStopping,  ///< As do people who stopped learning before.
};

/// An answer that shows a misconception.
struct TellingAnswer {
  std::size_t period = 0;
  std::size_t test = 0;  ///< 1-based within the period.
  StartIndex start;
  /// How many times as probable the answer is from people who violate the constraint as from those who satisfy it,
  /// among all who know the prior; nothing if nobody who satisfies it gives it.
  std::optional<double> factor{};
  std::string text;  ///< prediction_in_words(), or what the answer shows where counts are expectations.
};

/// What a person gets wrong about a component.
struct LikelyMisconception {
  Misbelief misbelief;
  double probability = 0.0;            ///< That the person would violate the constraint if asked now.
  std::string thinks;                  ///< in_words() of the misbelief.
  std::string fact;                    ///< in_words() of the constraint.
  std::vector<TellingAnswer> answers;  ///< The most telling ones, in order of time; may be empty.
  std::optional<StartIndex> show{};    ///< The simplest demonstration that conveys the constraint to this person.
  std::string reason{};                ///< What it shows; see Contrast.
};

/// A person and a component.
struct ComponentAudit {
  std::size_t component = 0;  ///< Index into Atlas::knowledge_components().
  Understanding understanding = Understanding::kNotTaught;
  Doubt doubt = Doubt::kNone;
  /// How often the person would satisfy all constraints of the component: `probability` is that of understanding.
  CredibleLevel level;
  std::size_t periods = 0;   ///< With lessons about it.
  std::size_t examined = 0;  ///< Boards of an exam that ask about it.
  std::size_t tests = 0;     ///< Asked in all of these; one that stopped short or was not answered in time is wrong.
  std::size_t correct = 0;   ///< Of them.
  /// The likeliest of the component's; nothing if it is not taught yet, or too unlikely to speak of.
  std::optional<LikelyMisconception> misconception{};
  /// The simplest start that tests what the person gets wrong, or else what is least certain; another one than was
  /// shown or asked before, or is to be shown now, if there is any.
  std::optional<StartIndex> test{};
  /// With Understanding::kUnderstands: after how many periods without lessons to test again; 0: it will not be needed
  /// within kLongestBreak.
  std::size_t test_after = 0;
};

/// A person.
struct PersonAudit {
  std::vector<ComponentAudit> components;
  Agreement agreement;  ///< Of the answers with what the model expects.
  /// Whether some hypothesis explains the answers. If none does, the levels are those of level_by_answers(), and no
  /// misconception is named.
  bool is_explained = true;
  double learning = 1.0;  ///< Probability that lessons (still) reach the person.
  double guessing = 0.0;  ///< Probability that the answers are guesses, or any paths.
  /// Probability that the person believes the robot to be as it was before an update, where that is not how it is now:
  /// of weights in AuditOptions::bank.known but outside the policy's class. Nothing without an update, or if no
  /// hypothesis explains the answers.
  std::optional<double> believes_older{};

  /// The one figure for what the person knows: how often they are expected to get all of a component right, as a mean
  /// over the components that they were taught; nothing before the first lesson.
  [[nodiscard]] std::optional<double> knowledge() const;
};

/// Periods; nobody plans further ahead.
inline constexpr std::size_t kLongestBreak = 24;

struct AuditOptions {
  MisconceptionBank::Options bank{};
  CredibleLevelOptions level{};
  double sure = 0.95;  ///< Probability from which a person is said to understand.
  /// At most this share of people who guess, or whom no lesson ever reaches, can be said to understand anything.
  double wrongly = 0.02;
  /// How many times as probable the answers of somebody who is said to understand have to be from people who learn as
  /// from anybody who stopped before (MisconceptionBank::odds_against_stopping()). With 3.5, at most 2 % of those who
  /// stop half way are said to understand what they do not (docs/audit.md).
  double against_stopping = 3.5;
  /// The same of people who were examined, whose answers must also be 1 / wrongly times as probable as from those who
  /// guess every other time (MisconceptionBank::odds_against_halves()).
  double against_stopping_examined = 0.5;
  /// Agreement::p below which the answers of a person count as not explained.
  double unexplained = 0.01;
  double likely = 0.5;      ///< Probability from which a misconception is said to be there.
  double negligible = 0.1;  ///< Below this no misconception is named.
  double telling = 3.0;     ///< TellingAnswer::factor of an answer that shows a misconception.
  std::size_t most_answers = 3;
  double forgetting = 0.02;  ///< Radians by which beliefs blur in a period without lessons; >= 0.
};

/// Judges from their answers who understands what.
///
/// A person is said to understand a component if the level is high enough with probability `sure`, and the answers tell
/// the person from people who guess or never learn (MisconceptionBank::odds_of_learning() >= 1 / wrongly) and from
/// people who stopped too early. Not thread-safe: it uses the cache.
class Auditor {
 public:
  /// @param cache  stays valid as long as this object. @throws std::invalid_argument if an option is out of range.
  Auditor(TeachingCache& cache, const AuditOptions& options);

  /// @param periods  all that was observed of the person, in order.
  /// @param random  moves the points of beliefs; equal streams give equal results.
  [[nodiscard]] PersonAudit audit(std::span<const ObservedPeriod> periods, const RandomStream& random);
  /// Several people; those who had the same lessons share LessonBeliefs, which saves most of the time.
  /// @param people  the periods of each. @return one audit each.
  [[nodiscard]] std::vector<PersonAudit> audit_group(std::span<const std::vector<ObservedPeriod>> people,
                                                     const RandomStream& random);

  /// What an audit says of a person by the bank that observed the periods, without misconceptions and what to ask next.
  [[nodiscard]] PersonAudit judge(const MisconceptionBank& bank, std::span<const ObservedPeriod> periods) const;

  /// The constraints of a component that people may violate, sorted.
  [[nodiscard]] const std::vector<HalfSpace>& constraints_of(std::size_t component) const {
    return constraints_[component];
  }

 private:
  void count(std::span<const ObservedPeriod> periods, std::vector<ComponentAudit>& audits) const;
  [[nodiscard]] Doubt doubt(const MisconceptionBank& bank, const ComponentAudit& audit) const;
  void name_misconception(const MisconceptionBank& bank, std::span<const ObservedPeriod> periods,
                          ComponentAudit& audit);
  void judge_by_answers(ComponentAudit& audit, bool is_judged) const;
  [[nodiscard]] double probability_of_older(const MisconceptionBank& bank) const;
  [[nodiscard]] std::optional<LikelyMisconception> misconception(const MisconceptionBank& bank, std::size_t component,
                                                                 std::span<const ObservedPeriod> periods);
  [[nodiscard]] Misbelief limited(const MisconceptionBank& bank, const HalfSpace& violated) const;
  [[nodiscard]] std::vector<TellingAnswer> telling(const HalfSpace& violated, std::span<const ObservedPeriod> periods);
  [[nodiscard]] bool concerns(const HalfSpace& constraint, const IntegerVector& difference) const;
  [[nodiscard]] std::optional<double> factor(const HalfSpace& violated, const Test& test, const Answer& answer,
                                             const Verdict& verdict);
  [[nodiscard]] std::string answer_in_words(const Test& test, const Answer& answer, const Verdict& verdict) const;
  void choose_demonstration(const MisconceptionBank& bank, std::size_t component,
                            std::span<const ObservedPeriod> periods, LikelyMisconception& misconception);
  [[nodiscard]] std::optional<StartIndex> choose_test(const MisconceptionBank& bank, const ComponentAudit& audit,
                                                      std::span<const ObservedPeriod> periods) const;
  [[nodiscard]] PersonAudit audit(std::span<const ObservedPeriod> periods, std::shared_ptr<LessonBeliefs> beliefs,
                                  const RandomStream& random);
  void plan_tests(const MisconceptionBank& bank, const RandomStream& random, std::vector<ComponentAudit>& audits) const;

  TeachingCache* cache_;
  AuditOptions options_;
  std::vector<std::vector<HalfSpace>> constraints_;  // per component
  std::size_t unit_ = 0;                             // the reference feature
  struct Somebody {
    Direction weights;
    PolicyCellIndex cell;  // where behaviours are tabulated
  };
  std::vector<Somebody> everybody_;  // who knows the prior
};

}  // namespace kith
