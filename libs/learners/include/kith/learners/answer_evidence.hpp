#pragma once

#include <span>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith {

/// A path that somebody gave as the answer to a test.
struct GivenAnswer {
  StartIndex test;
  IntegerVector counts;  ///< Of its features.
};

/// What one answer says about the weights that a person had in mind: that they lie in the cone, or that they do not.
struct AnswerRegion {
  std::vector<HalfSpace> cone;
  bool inside = true;
};

/// How AnswerEvidence keeps half-spaces.
enum class EvidenceForm {
  kMinimal,  ///< As minimal sets.
  kAsGiven,  ///< Each once. For many half-spaces in many dimensions, where minimal sets cost more than they save.
};

/// The answers that a person gave in one period, as a learner model rates them: which weights give exactly these
/// answers, among the weights that give any.
class AnswerEvidence {
 public:
  /// @param possible  the weights that have an answer to every test; empty: all.
  /// @param answers  one region per answer; empty: the person did not answer.
  /// @param chance  probability of these answers by guessing, in [0, 1].
  /// @param form  kAsGiven does not find out whether the answers are contradictory.
  AnswerEvidence(std::span<const HalfSpace> possible, std::span<const AnswerRegion> answers, double chance,
                 EvidenceForm form = EvidenceForm::kMinimal);

  /// With paths: which weights give these answers, and, for people whose answers are not always the best path for some
  /// weights, the answers themselves. The atlas must outlive it. @pre the atlas has tables.
  AnswerEvidence(const Atlas& atlas, std::span<const GivenAnswer> answers);

  /// Whether there are no answers.
  [[nodiscard]] bool empty() const noexcept { return is_empty_; }
  /// Whether no weights give these answers.
  [[nodiscard]] bool is_contradictory() const noexcept { return is_contradictory_; }
  [[nodiscard]] double chance() const noexcept { return chance_; }
  /// The weights that have an answer to every test.
  [[nodiscard]] const std::vector<HalfSpace>& possible() const noexcept { return possible_; }
  /// Those of them that lie in the cone of every answer with `inside`.
  [[nodiscard]] const std::vector<HalfSpace>& consistent() const noexcept { return consistent_; }
  /// The cones of the other answers: weights in any of them give another answer.
  [[nodiscard]] const std::vector<std::vector<HalfSpace>>& outside() const noexcept { return outside_; }
  /// The answers themselves, if they were given as paths; else empty.
  [[nodiscard]] const std::vector<GivenAnswer>& paths() const noexcept { return paths_; }
  /// Of the tests. @pre paths() is not empty.
  [[nodiscard]] const Atlas& atlas() const noexcept { return *atlas_; }

 private:
  void keep_as_given(std::span<const HalfSpace> possible, std::span<const AnswerRegion> answers);

  bool is_empty_;
  bool is_contradictory_ = false;
  double chance_;
  std::vector<HalfSpace> possible_;
  std::vector<HalfSpace> consistent_;
  std::vector<std::vector<HalfSpace>> outside_;
  std::vector<GivenAnswer> paths_;
  const Atlas* atlas_ = nullptr;
};

}  // namespace kith
