#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kith/explain/audit.hpp"
#include "kith/explain/json.hpp"
#include "kith/teaching/learner_bank.hpp"

namespace kith {

/// A person of a run or of a live session, judged by the answers.
struct AuditedPerson {
  std::size_t team = 0;    ///< Number of the team in its run; 0: of a room.
  std::string group;       ///< As people read it: "team 17 (joint, NNP, replicate 2)", "room r3 (joint, NNP)".
  std::string room;        ///< Id of the room; empty: of a run.
  std::size_t member = 1;  ///< 1-based. In a room the place, which several people may have had in turn.
  std::size_t seat = 0;    ///< Who had it, 1-based; 0: of a run.
  char type = 'N';         ///< Learner type of the place.
  bool simulated = true;   ///< Whether a simulated learner answered.
  PersonAudit audit;
  std::vector<KindProbability> kinds{};  ///< What kind of learner this is, if the study asks for it; else empty.
};

/// "Member 2 (P)", "Member 2 (P, a person in seat 4)".
[[nodiscard]] std::string title_of(const AuditedPerson& person);

/// An audit of a run or of a live session.
struct AuditReport {
  std::string source;  ///< The folder, as it was named.
  std::vector<AuditedPerson> people;
  AuditOptions options;
};

/// How many people stand how with a component.
struct AuditCounts {
  std::size_t understand = 0, cannot_tell = 0, misconception = 0, not_taught = 0;
};
[[nodiscard]] AuditCounts counts_of(const AuditReport& report, std::size_t component);

/// How far the answers of all of these people agree with the model: sums over the people, and p of a normal
/// distribution of their number of right answers. Empty `group`: of everybody.
[[nodiscard]] Agreement agreement_of(const AuditReport& report, const std::string& group = {});
/// People whose answers no hypothesis explains.
[[nodiscard]] std::size_t num_unexplained(const AuditReport& report, const std::string& group = {});
/// "The answers fit what the model expects: 62 of 80 are right, 60.3 were expected (p = 0.71)." or "There are fewer
/// right answers than the model expects: ...", with the number of people whose answers no hypothesis explains.
[[nodiscard]] std::string agreement_in_words(const AuditReport& report, const std::string& group = {});
/// What to know of a person before reading the verdicts: that the answers are not explained, look like guesses, or that
/// lessons do not seem to reach the person. Empty if there is nothing.
[[nodiscard]] std::string caution_in_words(const PersonAudit& audit);
/// "still believes in the robot as it was before the update with probability 83 %"; empty without an update.
[[nodiscard]] std::string older_in_words(const PersonAudit& audit);
/// Who more likely than not does: "These people still seem to believe in the robot as it was before the update: ...".
[[nodiscard]] std::string older_in_words(const AuditReport& report);
/// Why somebody needs help: lessons do not reach them, or several lessons about a component have not mended what they
/// think. Empty if nothing says so.
[[nodiscard]] std::string need_in_words(const PersonAudit& audit);

/// A misconception that several people have about a component.
struct SharedMisconception {
  std::size_t component = 0;
  std::string fact;
  std::vector<std::string> thinks;  ///< What they think, the most frequent first; without repetitions.
  std::size_t people = 0;
};
/// Of people with Understanding::kMisconception, the most frequent first.
[[nodiscard]] std::vector<SharedMisconception> shared_misconceptions(const AuditReport& report);

/// "understands", "has a misconception", "cannot tell yet" or "not taught yet".
[[nodiscard]] std::string in_words(Understanding understanding);
/// The same, with the reason where nothing can be told: "cannot tell yet: ...".
[[nodiscard]] std::string verdict_in_words(const ComponentAudit& audit);
/// What to do about it: "test again after 8 periods without lessons", "show the demonstration and test again in the
/// next lesson". Empty if nothing is to do.
[[nodiscard]] std::string advice_in_words(const ComponentAudit& audit);

/// The document kith.audit/1 (docs/json.md), which the audit's page draws. @param program  that made it, such as
/// "kith 0.1.0".
[[nodiscard]] Json audit_json(const Atlas& atlas, const AuditReport& report, const std::string& program);

}  // namespace kith
