#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "kith/teaching/credible_level.hpp"
#include "kith/teaching/misconception_bank.hpp"

namespace kith {

/// Chooses the tests of an exam one by one, each for what its answer is expected to tell.
///
/// Of each component somebody understands it, or violates one of its constraints whatever is shown, or has not learned
/// it, or guesses. With the probabilities of a MisconceptionBank a start tells
///
///   sum over components of H(kind) - sum_a P(a) H(kind | a)
///
/// with the entropy H and the answers a that people can give there, as AnswerFit rates them. Candidates are all starts
/// of the domain where behaviours are tabulated, else those of the TeachingCache's samples, with answers that are right
/// or wrong.
class ExamChooser {
 public:
  /// @param is_usable  which starts people can be asked about; empty: all.
  explicit ExamChooser(TeachingCache& cache, const std::function<bool(StartIndex)>& is_usable = {});

  /// The start that tells most about these components, the simplest of those that tell as much; nothing if no start
  /// tells anything.
  /// @param bank  of one person, without further lessons between two calls.
  /// @param components  the constraints of each.
  [[nodiscard]] std::optional<StartIndex> choose(const MisconceptionBank& bank,
                                                 std::span<const std::vector<HalfSpace>> components,
                                                 const CredibleLevelOptions& level);
  /// It was shown or asked: neither it nor any that look like it are chosen from now on.
  void leave_out(StartIndex start);

 private:
  // Starts that are one and the same question to everybody.
  struct Question {
    std::vector<StartIndex> starts{};    // the simplest last
    HullIndex hull{};                    // where behaviours are tabulated
    std::vector<HalfSpace> examined{};   // of who answers right, elsewhere
    std::size_t first = 0, answers = 2;  // places of its answers' probabilities
  };
  void gather(std::span<const StartIndex> starts);
  [[nodiscard]] std::vector<double> answers_of(const PossiblePerson& person) const;
  void add_guesses(AnswerFit::Guess guess, std::vector<double>& answers) const;
  void add_answers_by_cell(std::span<const double> masses, std::vector<double>& answers) const;

  const Atlas* atlas_;
  std::vector<Question> questions_;
  std::size_t num_answers_ = 0;
  std::map<const KnownBelief*, std::vector<double>> known_;  // answers_of() people with a belief
};

}  // namespace kith
