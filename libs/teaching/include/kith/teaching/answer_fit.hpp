#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/teaching/lesson.hpp"

namespace kith {

/// The policy cells of a belief's points, which stay as long as nothing is resampled; a cache.
class PointCells {
 public:
  /// @pre behaviours are tabulated.
  [[nodiscard]] std::span<const std::uint32_t> of(const Atlas& atlas, const ParticleBelief& belief);

 private:
  std::size_t num_resamplings_ = 0;
  std::vector<std::uint32_t> cells_;
};

/// How well the answers of one person in one period fit a belief, or nothing at all.
///
/// All answers of a period come from one weight x of the belief B, but each is given by chance with probability
/// e = slip():
///
///   P = sum_x B(x) prod_t ((1 - e) [x answers a_t] + e q_t) / sum_x B(x) [x has answers],
///
/// with q_t = 1 / (n + 1), where n paths are best for some weights: any of these, or one that is best for nobody.
/// People who guess answer by chance throughout; some hardly ever take a path that is best for nobody (0.01), some
/// often do (0.5). Such a path is always a slip of those who believe something; where weights in the prior could prefer
/// it to the robot's, 0.1 e q_t for weights that do not. Where behaviours are not tabulated, a right answer is given by
/// the weights that satisfy the constraints which the test examines, a wrong one by those that prefer it to the robot's
/// path, and q_t = 1/4, for all who guess. A test without an answer, as of somebody who stopped short or ran out of
/// time, says nothing (Missing::kSaysNothing) or is wrong, as a path that is best for nobody (Missing::kIsWrong).
class AnswerFit {
 public:
  /// What a test without an answer tells.
  enum class Missing { kSaysNothing, kIsWrong };

  /// e: the probability that an answer is not what the person believes.
  [[nodiscard]] static constexpr double slip() noexcept { return 0.02; }
  /// The probability that a guess is right where behaviours are not tabulated.
  [[nodiscard]] static constexpr double chance() noexcept { return 0.25; }
  /// How people guess.
  enum class Guess { kSensible, kAny };
  /// The probability that a guess is a path that is best for nobody.
  [[nodiscard]] static constexpr double best_for_nobody(Guess guess) noexcept {
    return guess == Guess::kSensible ? 0.01 : 0.5;
  }

  /// One answer and one verdict per test. The arguments are not kept.
  AnswerFit(const Atlas& atlas, std::span<const Test> tests, std::span<const Answer> answers,
            std::span<const Verdict> verdicts, Missing missing = Missing::kSaysNothing);

  /// An answer that was given.
  struct Given {
    StartIndex start;
    IntegerVector counts;
  };
  [[nodiscard]] std::span<const Given> given() const noexcept { return given_; }
  [[nodiscard]] const Atlas& atlas() const noexcept { return *atlas_; }

  /// Tests that were answered, or count as answered wrong.
  [[nodiscard]] std::size_t num_tests() const noexcept { return tests_.size(); }
  /// Of them, answered right.
  [[nodiscard]] std::size_t num_right() const noexcept { return num_right_; }

  /// What is expected of somebody.
  struct Rating {
    double likelihood = 1.0;    ///< P: of exactly these answers, in [0, 1].
    std::vector<double> right;  ///< The distribution of the number of right answers, shape [num_tests() + 1].
  };
  /// Of somebody who answers by a belief. @param cells  those of the belief's points; only changed as a cache.
  [[nodiscard]] Rating of(const ParticleBelief& belief, PointCells& cells) const;
  /// Whether policy cells tell every answer.
  [[nodiscard]] bool is_by_cells() const noexcept;
  /// The same by the mass of every policy cell. @pre is_by_cells().
  [[nodiscard]] Rating of(std::span<const double> cell_masses) const;
  /// Of somebody who guesses.
  [[nodiscard]] const Rating& of(Guess guess) const noexcept { return guesses_[guess == Guess::kSensible ? 0 : 1]; }

 private:
  struct OneTest {
    double chance = 0.0;                     // q
    double num_paths = 0.0;                  // n; 0 where behaviours are not tabulated
    double right_by_chance = 0.0;            // probability that a guess is right
    bool by_cell = false;                    // the answer is that of policy cells
    bool by_nobody = false;                  // the answer is best for nobody
    std::vector<std::size_t> answered_by{};  // half-spaces of the weights that answer so, unless by_cell
    std::vector<std::size_t> examined{};     // of those that answer right, where behaviours are not tabulated
  };
  // Whether each point is in each of half_spaces_, shape [half_spaces_][points].
  using Inside = std::vector<std::vector<char>>;
  [[nodiscard]] std::vector<std::size_t> numbers_of(std::span<const HalfSpace> half_spaces);
  void read_cells(const Test& asked, const Answer& answer, OneTest& test);
  [[nodiscard]] Inside locate(const ParticleBelief& belief) const;
  // Of the answer to a test, by whether a point fits it.
  struct PointFit {
    std::vector<char> fits, is_right{};  // per point; whether it answers right only where behaviours are not tabulated
    double if_fits, else_factor;
  };
  [[nodiscard]] std::vector<PointFit> rate(const ParticleBelief& belief) const;
  [[nodiscard]] std::vector<double> with_slips(const std::vector<double>& right) const;

  const Atlas* atlas_;
  const BehaviourTables* tables_;  // the atlas's; nothing where it has none
  std::vector<OneTest> tests_;
  std::vector<Given> given_;            // in the same order, without those that are missing
  std::vector<HalfSpace> half_spaces_;  // that tests name, each once
  std::size_t num_right_ = 0;
  std::array<Rating, 2> guesses_;
  std::vector<double> factor_of_cell_;  // product over the tests by_cell; below 0: some test has no answer
  std::vector<std::uint32_t> num_right_of_cell_;
};

}  // namespace kith
