#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kith {

/// A comparison planned beforehand: a weighted sum of the estimated marginal means of one factor's levels.
struct PlannedContrast {
  struct Weight {
    std::string level;
    double weight = 1.0;
    friend bool operator==(const Weight&, const Weight&) = default;
  };
  std::string name;               ///< "team beliefs - individual beliefs"
  std::string factor{};           ///< Empty: the factor of the model that has all these levels.
  std::vector<Weight> weights{};  ///< No level twice; their sum is 0.
  std::string response{};         ///< Of the analyses of a run: an outcome, such as "periods"; empty: all.
  bool primary = false;           ///< Of the analyses of a run: a hypothesis, see analyze_run().
  friend bool operator==(const PlannedContrast&, const PlannedContrast&) = default;
};

/// The mean of some levels less the mean of others.
[[nodiscard]] PlannedContrast difference_of_means(std::string name, const std::vector<std::string>& of,
                                                  const std::vector<std::string>& against);

/// Reads "NAME [FACTOR]: TERMS", in which the name and the factor in brackets may be left out:
///
///   joint + common - individual-high - individual-low     mean of the first two less mean of the others
///   H1 [strategy]: 0.5*joint + 0.5*common - 1*baseline    these weights
///
/// Signs stand between blanks; levels with blanks or signs of their own are put in back-quotes. Without numbers, what
/// is added is averaged, and so is what is subtracted.
/// @throws kith::Error (kUsage) for anything else, for a level that occurs twice and for weights whose sum is not 0.
[[nodiscard]] PlannedContrast parse_contrast(std::string_view text);

/// The smallest effect that would matter (smallest effect size of interest): differences nearer to 0 are as good as
/// none.
struct SmallestEffect {
  double size = 0.0;          ///< > 0
  bool standardized = false;  ///< In standard deviations (d), not in units of the response.
};
/// Reads "0.5" or "d=0.3". @throws kith::Error (kUsage) unless it is a number above 0.
[[nodiscard]] SmallestEffect parse_smallest_effect(std::string_view text);

}  // namespace kith
