// Weights that explain what a robot does.
#include "kith/bec/inference.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <unordered_set>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/core/math.hpp"
#include "kith/geometry/cover.hpp"
#include "policy_fit.hpp"

namespace kith {
namespace detail {
namespace {

constexpr double kLeastExplained = 0.5;          // of a policy that is explained at all
constexpr double kMostChance = 0.05;             // that a robot that acts at random is explained as well
constexpr std::size_t kMostPlanned = 4'000'000;  // states, in looking for the best of the weights that cover the prior
constexpr std::size_t kFewestLooks = 32, kMostLooks = 512;  // of those
constexpr std::size_t kLooksImproved = 6;                   // how many of them
constexpr std::size_t kMostImprovements = 40;
constexpr int kFewestDigits = 2, kMostDigits = 8;  // of weights, after the point

Weights as_weights(const Direction& w) { return {w.data(), w.data() + w.size()}; }

// The middle of the extreme rays, or any direction inside.
Weights centre_of(const Cone& region) {
  Weights sum(region.dimension(), 0.0);
  for (const IntegerVector& ray : region.generators()) {
    double length = 0.0;
    for (const std::int64_t x : ray) length += static_cast<double>(x) * static_cast<double>(x);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += static_cast<double>(ray[k]) / std::sqrt(length);
  }
  const double size =
      *std::max_element(sum.begin(), sum.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  if (std::abs(size) > kExplainTolerance && margin_of(region, at_length_1(sum)) > 0.0) return at_length_1(sum);
  const IntegerVector inside = region.interior_direction();
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = static_cast<double>(inside[k]);
  return at_length_1(sum);
}

std::optional<Weights> rounded_to(const Weights& w, int digits) {
  double unit = 1.0;
  for (int i = 0; i < digits; ++i) unit *= 10.0;
  Weights few;
  for (const double x : w) few.push_back(std::round(x * unit) / unit + 0.0);
  const bool is_zero = std::ranges::all_of(few, [](double x) { return x == 0.0; });
  return is_zero ? std::nullopt : std::optional{few};
}

// Nearly the same direction, with as few digits as leave most of the margin, or else as much of it as any do.
Weights rounded(const Weights& w, const Cone& region) {
  const double margin = margin_of(region, w);
  Weights best = w;
  double most = 0.0;
  for (int digits = kFewestDigits; digits <= kMostDigits; ++digits) {
    const auto few = rounded_to(w, digits);
    const double left = few ? margin_of(region, at_length_1(*few)) : 0.0;
    if (left <= most) continue;
    best = *few;
    most = left;
    if (left > 0.9 * margin) break;
  }
  return best;
}

class PolicyInference {
 public:
  PolicyInference(const Domain& domain, const ObservedPolicy& policy)
      : fit_{domain, policy}, prior_{domain.num_features()} {
    if (!prior_.clip(domain.prior())) throw std::logic_error{"infer_weights: the prior has no interior"};
  }

  WeightInference infer() {
    std::optional<Look> found;
    if (const auto region = optimal_region()) found = fit_.looked_at(rounded(centre_of(*region), *region));
    if (!found || found->share < 0.0 || !fit_.explains_all_likeliest(*found)) found = search();
    auto shown = shown_inside(*found);
    if (const auto tied = is_all(found->share) ? std::nullopt : shown.with_ties()) {
      auto better = fit_.looked_at(*tied);
      if (is_all(better.share)) found = std::move(better);
    }
    WeightInference result;
    result.is_optimal = is_all(found->share);
    if (!result.is_optimal) refuse_chance(*found);
    if (shown.region == prior_) refuse_indifference();

    result.weights = found->weights;
    result.margin = std::max(margin_of(shown.region, at_length_1(found->weights)), 0.0);
    describe_fit(fit_, *found, shown, result);
    result.region = shown.region;
    if (result.left_out.size() >= fit_.domain().num_starts()) refuse_starts(result);
    return result;
  }

 private:
  static bool is_all(double share) { return share > 1.0 - kExplainTolerance; }

  // Exactly, if the policy is known everywhere; nothing if it is not, or has none.
  [[nodiscard]] std::optional<Cone> optimal_region() {
    Cone region = prior_;
    for (std::size_t m = 0; m < fit_.domain().num_mdps(); ++m) {
      if (std::find(fit_.likeliest(m).begin(), fit_.likeliest(m).end(), kNoChoice) != fit_.likeliest(m).end())
        return std::nullopt;
      const auto counts = count_policy(fit_.mdp(m), fit_.likeliest(m), fit_.domain().count_scale());
      if (!counts) return std::nullopt;
      for (std::size_t s = 0; s < fit_.likeliest(m).size(); ++s) {
        for (const HalfSpace& half_space : fit_.demands(m, s, *counts, fit_.likeliest(m)[s])) {
          if (!region.implies(half_space) && !region.clip(half_space)) return std::nullopt;
        }
      }
    }
    return region;
  }

  // --- search ---

  [[nodiscard]] Look search() {
    const auto n = std::clamp(kMostPlanned / std::max<std::size_t>(fit_.num_states(), 1), kFewestLooks, kMostLooks);
    const Eigen::MatrixXd points = cover(prior_, n);
    std::vector<Look> looks;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      auto look = fit_.looked_at(as_weights(points.col(i)));
      if (look.share >= 0.0) insert(looks, std::move(look));
    }
    if (looks.empty()) {
      throw Error{ErrorKind::kInfeasible, "no weights were found for which what is best is finite",
                  Advice{"set a discount below 1 in [mdp], or give actions a cost that everybody knows under [prior]"}};
    }
    Look best = looks.front();
    for (Look& look : looks) {
      auto improved = improve(std::move(look));
      if (improved.is_better_than(best)) best = std::move(improved);
    }
    return best;
  }

  // Keeps the best few.
  static void insert(std::vector<Look>& looks, Look look) {
    const auto at =
        std::find_if(looks.begin(), looks.end(), [&](const Look& other) { return look.is_better_than(other); });
    if (at == looks.end() && looks.size() >= kLooksImproved) return;
    looks.insert(at, std::move(look));
    if (looks.size() > kLooksImproved) looks.pop_back();
  }

  [[nodiscard]] Look improve(Look look) {
    for (std::size_t round = 0; round < kMostImprovements; ++round) {
      auto next = fit_.looked_at(centre_of(most_satisfied(look)));
      if (next.share < 0.0 || !next.is_better_than(look)) break;
      look = std::move(next);
    }
    return look;
  }

  struct Demand {
    double margin;
    std::vector<HalfSpace> half_spaces;
  };

  // Clips the prior by what states demand, from the state that is satisfied best on; those that leave nothing do not
  // count. What comes later is best under the weights of the look.
  [[nodiscard]] Cone most_satisfied(const Look& look) const {
    std::vector<Demand> all;
    std::unordered_set<HalfSpace> met;
    for (std::size_t m = 0; m < fit_.domain().num_mdps(); ++m) {
      for (std::size_t s = 0; s < fit_.likeliest(m).size(); ++s) {
        if (fit_.likeliest(m)[s] == kNoChoice) continue;
        Demand demand{1.0, fit_.demands(m, s, look.plans[m].counts, fit_.likeliest(m)[s])};
        bool is_new = false;
        for (const HalfSpace& half_space : demand.half_spaces) {
          demand.margin = std::min(demand.margin, margin_of(half_space, look.weights));
          is_new = met.insert(half_space).second || is_new;
        }
        if (is_new) all.push_back(std::move(demand));
      }
    }
    std::stable_sort(all.begin(), all.end(), [](const Demand& a, const Demand& b) { return a.margin > b.margin; });
    Cone region = prior_;
    for (const Demand& demand : all) {
      Cone smaller = region;
      if (smaller.clip(demand.half_spaces)) region = std::move(smaller);
    }
    return region;
  }

  // What the look explains, and in its place one in the middle of the weights that do: with few digits.
  [[nodiscard]] ShownRegion shown_inside(Look& look) {
    constexpr int kMostTurns = 3;
    auto shown = shown_region(fit_, look, prior_);
    for (int turn = 0; turn < kMostTurns; ++turn) {
      auto inside = fit_.looked_at(rounded(centre_of(shown.region), shown.region));
      if (inside.share < look.share) break;
      const bool is_as_before = is_all(look.share);
      look = std::move(inside);
      if (is_as_before) return shown;
      shown = shown_region(fit_, look, prior_);
    }
    for (int digits = kFewestDigits; digits <= kMostDigits; ++digits) {
      const auto few = rounded_to(look.weights, digits);
      auto next = few ? fit_.looked_at(*few) : Look{};
      if (next.share < look.share) continue;
      look = std::move(next);
      break;
    }
    return shown;
  }

  // --- what is refused ---

  // The chance that a robot that takes each choice alike does what is best in so many states, for one of the behaviours
  // that were looked at.
  void refuse_chance(const Look& look) const {
    double by_chance = 0.0;
    double explained = 0.0;
    std::size_t count = 0;
    const auto w = at_length_1(look.weights);
    for (std::size_t m = 0; m < fit_.domain().num_mdps(); ++m) {
      for (std::size_t s = 0; s < fit_.likeliest(m).size(); ++s) {
        const auto choices = fit_.mdp(m).choices(StateIndex{s}).size();
        if (!fit_.is_seen(m, s) || choices < 2) continue;
        std::size_t best = 0;
        for (std::uint32_t c = 0; c < choices; ++c) best += fit_.is_best(look, m, s, c) ? 1u : 0u;
        by_chance += static_cast<double>(best) / static_cast<double>(choices);
        explained += fit_.explained_at(look, m, s, w).share;
        ++count;
      }
    }
    const auto n = static_cast<double>(std::max<std::size_t>(count, 1));
    const double p = by_chance / n;
    const double x = std::min(explained / n, 1.0);
    const auto part = [](double a, double b) { return a > 0.0 ? a * math::log(a / b) : 0.0; };
    const double divergence = x <= p || p >= 1.0 ? 0.0 : part(x, p) + part(1.0 - x, 1.0 - p);
    const double chance = math::log(static_cast<double>(fit_.num_behaviours())) - n * divergence;
    if (look.share >= kLeastExplained && chance < math::log(kMostChance)) return;
    const auto percent = [](double part_of) { return std::to_string(std::lround(100.0 * part_of)) + " %"; };
    refuse("E0341",
           "no weights explain what this robot does: the best explain " + percent(look.share) +
               " of it; of a robot that acts at random these weights would explain " + percent(p),
           "check that states and actions are those of the domain; if they are, another feature has to tell apart what "
           "the robot tells apart");
  }

  [[noreturn]] void refuse_indifference() const {
    refuse("E0342", "nothing follows from what was seen: whatever the robot could have done there may count the same",
           "record more of it, or give the domain features that differ between actions");
  }

  [[noreturn]] void refuse_starts(const WeightInference& result) const {
    refuse("E0343",
           "from every start the robot meets a state that the weights do not explain (" +
               std::to_string(result.unexplained.size()) + ") or in which it was not seen (" +
               std::to_string(fit_.num_states() - fit_.num_seen()) + ")",
           "record whole paths to an end, or add a feature that explains more");
  }

  [[noreturn]] static void refuse(const std::string& id, const std::string& message, const std::string& hint) {
    Diagnostic diagnostic;
    diagnostic.id = id;
    diagnostic.message = message;
    diagnostic.hint = hint;
    diagnostic.infeasible = true;
    throw Error{ErrorKind::kInfeasible, message, {diagnostic}};
  }

  PolicyFit fit_;
  Cone prior_;
};

}  // namespace
}  // namespace detail

InferredWeights as_inferred(const WeightInference& inference) {
  return {inference.share, inference.loss, inference.margin, inference.left_out.size(), inference.not_explained};
}

WeightInference infer_weights(const Domain& domain, const ObservedPolicy& policy) {
  if (domain.num_features() < 2) {
    throw Error{ErrorKind::kInfeasible, "domain '" + domain.id() + "' has a single feature: there is nothing to weigh"};
  }
  return detail::PolicyInference{domain, policy}.infer();
}

}  // namespace kith
