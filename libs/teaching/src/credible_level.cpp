#include "kith/teaching/credible_level.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/tools/roots.hpp>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace kith {
namespace {

constexpr double kLeastShare = 1e-3;  // Beta needs shares inside (0, 1)

// P(X < x) of X ~ Beta(a, b), in double precision throughout: long double would take three times as long.
double below_share(double a, double b, double x) {
  using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return boost::math::ibeta(a, b, x, InDouble{});
}

class Mixture {
 public:
  Mixture(std::span<const WeightedShare> shares, double precision) {
    constexpr double kIgnored = 1e-4, kNearlySame = 0.005;
    double sum = 0.0;
    for (const auto& one : shares) sum += one.weight;
    if (!(sum > 0.0)) throw std::invalid_argument{"credible_level: no weight is above 0"};
    std::vector<WeightedShare> kept;
    for (const auto& one : shares) {
      mean_ += one.weight / sum * one.share;
      if (one.weight / sum < kIgnored) continue;
      kept.push_back({one.weight / sum, std::clamp(one.share, kLeastShare, 1.0 - kLeastShare)});
      kept_ += one.weight / sum;
    }
    // Many hypotheses have nearly the same share: those together have their mean.
    std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.share < b.share; });
    for (std::size_t i = 0; i < kept.size();) {
      double weight = 0.0, share = 0.0;
      const double first = kept[i].share;
      for (; i < kept.size() && kept[i].share - first <= kNearlySame; ++i) {
        weight += kept[i].weight;
        share += kept[i].weight * kept[i].share;
      }
      share /= weight;
      parts_.push_back({weight, precision * share, precision * (1.0 - share)});
    }
  }
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double below(double share) const {
    double sum = 0.0;
    for (const auto& part : parts_) sum += part.weight * below_share(part.a, part.b, share);
    return std::min(sum / kept_, 1.0);  // rounding may leave a little more
  }
  [[nodiscard]] double quantile(double q) const {
    constexpr int kBits = 30;
    std::uintmax_t evaluations = 100;
    const auto [from, to] =
        boost::math::tools::toms748_solve([&](double share) { return below(share) - q; }, 0.0, 1.0, -q, 1.0 - q,
                                          boost::math::tools::eps_tolerance<double>(kBits), evaluations);
    return (from + to) / 2.0;
  }

 private:
  struct Part {
    double weight, a, b;
  };
  std::vector<Part> parts_;
  double mean_ = 0.0;
  double kept_ = 0.0;
};

bool is_share(double x) { return x > 0.0 && x < 1.0; }

}  // namespace

CredibleLevel credible_level(std::span<const WeightedShare> shares, const CredibleLevelOptions& options) {
  if (!is_share(options.enough) || !is_share(options.coverage) || !(options.precision > 0.0)) {
    throw std::invalid_argument{"credible_level: an option is out of range"};
  }
  const Mixture mixture{shares, options.precision};
  const double tail = (1.0 - options.coverage) / 2.0;
  return {.mean = mixture.mean(),
          .low = std::min(mixture.quantile(tail), mixture.mean()),
          .high = std::max(mixture.quantile(1.0 - tail), mixture.mean()),
          .probability = 1.0 - mixture.below(options.enough)};
}

double probability_of_enough(std::span<const WeightedShare> shares, const CredibleLevelOptions& options) {
  return 1.0 - Mixture{shares, options.precision}.below(options.enough);
}

double probability_of_enough(double share, const CredibleLevelOptions& options) {
  const double inside = std::clamp(share, kLeastShare, 1.0 - kLeastShare);
  return 1.0 - below_share(options.precision * inside, options.precision * (1.0 - inside), options.enough);
}

CredibleLevel level_by_answers(std::size_t right, std::size_t tests, const CredibleLevelOptions& options) {
  if (right > tests) throw std::invalid_argument{"level_by_answers: more right answers than tests"};
  const double precision = static_cast<double>(tests) + 2.0;
  const WeightedShare share{.weight = 1.0, .share = (static_cast<double>(right) + 1.0) / precision};
  auto as_answered = options;
  as_answered.precision = precision;
  return credible_level({&share, 1}, as_answered);
}

}  // namespace kith
