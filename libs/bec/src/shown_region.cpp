// The weights that explain what a robot was seen to do.
#include <algorithm>
#include <utility>

#include "kith/bec/comparison.hpp"
#include "kith/geometry/cover.hpp"
#include "policy_fit.hpp"
#include "robot_plan.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kMostVerified = 4'000'000;  // states that are planned in looking for what a region still allows
constexpr std::size_t kMostRounds = 50, kPointsBetween = 64;
constexpr double kRounding = 1e-5;  // of half-spaces whose counts are rounded

Weights as_real(const IntegerVector& w) { return {w.begin(), w.end()}; }

// What the robot does in an MDP, or what would be best where that is not known, and what it counts.
struct KnownWays {
  MdpIndex mdp;
  std::vector<std::uint32_t> choice;
  std::vector<IntegerVector> counts;
  std::vector<bool> is_explained, is_known, is_settled;  // settled: nothing unknown comes after it
};

// Where nothing unknown comes after a state, what the robot does there is worth w . counts under all weights that
// explain it, and no policy counts more under them: these half-spaces make the region. Those of one-step deviations are
// taken first; then the corners of the region are planned for, until none of them prefers anything else.
class RegionBuilder {
 public:
  RegionBuilder(const PolicyFit& fit, const Look& look, const Cone& prior)
      : fit_{fit}, look_{look}, shown_{prior, {}, {}} {}

  ShownRegion build() {
    std::vector<KnownWays> open;
    for (std::size_t m = 0; m < fit_.domain().num_mdps(); ++m) {
      auto ways = known_in(m);
      if (!ways) continue;
      take_steps(*ways);
      if (std::ranges::count(ways->is_settled, false) > 0) open.push_back(*std::move(ways));
    }
    bool has_changed = true;
    for (std::size_t round = 0; has_changed && round < kMostRounds; ++round) {
      has_changed = false;
      for (const Weights& w : corners_and_points_between()) {
        for (const KnownWays& ways : open) has_changed = look_at(ways, w) || has_changed;
      }
    }
    return std::move(shown_);
  }

 private:
  // Corners have often no finite optimum, so that what is between them counts, too.
  [[nodiscard]] std::vector<Weights> corners_and_points_between() const {
    std::vector<Weights> result;
    for (const IntegerVector& ray : shown_.region.generators()) result.push_back(at_length_1(as_real(ray)));
    const Eigen::MatrixXd points = cover(shown_.region, kPointsBetween);
    for (Eigen::Index i = 0; i < points.cols(); ++i) result.emplace_back(points.col(i).begin(), points.col(i).end());
    return result;
  }

  [[nodiscard]] std::optional<KnownWays> known_in(std::size_t m) const {
    const auto& mdp = fit_.mdp(m);
    KnownWays ways{MdpIndex{m}, look_.plans[m].choice, {}, {}, {}, {}};
    const auto n = ways.choice.size();
    for (std::size_t s = 0; s < n; ++s) {
      ways.is_explained.push_back(fit_.is_explained(look_, m, s));
      // What is odd counts as what would be best there: that is what the weights are asked about.
      ways.is_known.push_back(fit_.is_seen(m, s) || ways.is_explained[s]);
      if (ways.is_explained[s]) ways.choice[s] = fit_.likeliest(m)[s];
    }
    ways.is_settled = ways.is_known;
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      for (std::size_t s = n; s-- > 0;) {
        const bool is_certain = std::ranges::all_of(outcomes(ways, StateIndex{s}), [&](const Outcome& one) {
          return mdp.is_terminal(one.next) || ways.is_settled[one.next.value()];
        });
        if (!ways.is_settled[s] || is_certain) continue;
        ways.is_settled[s] = false;
        has_changed = true;
      }
    }
    auto counts = count_policy(mdp, ways.choice, fit_.domain().count_scale());
    if (!counts || std::ranges::count(ways.is_known, true) == 0) return std::nullopt;
    ways.counts = *std::move(counts);
    return ways;
  }

  [[nodiscard]] std::span<const Outcome> outcomes(const KnownWays& ways, StateIndex s) const {
    const auto& mdp = fit_.domain().mdp(ways.mdp);
    return mdp.outcomes(mdp.choices(s)[ways.choice[s.value()]]);
  }

  // Where the way leads from a state to one in which the robot was not seen. @pre there is no chance, and it does.
  [[nodiscard]] StateIndex unknown_after(const KnownWays& ways, StateIndex s) const {
    while (ways.is_known[s.value()]) s = outcomes(ways, s).front().next;
    return s;
  }

  [[nodiscard]] bool passes(const KnownWays& ways, StateIndex from, StateIndex through) const {
    for (std::size_t steps = 0; steps <= ways.choice.size(); ++steps) {
      if (from == through) return true;
      if (fit_.domain().mdp(ways.mdp).is_terminal(from)) return false;
      from = outcomes(ways, from).front().next;
    }
    return false;
  }

  void take_steps(const KnownWays& ways) {
    const auto m = ways.mdp.value();
    for (StateIndex s{0}; s.value() < ways.choice.size(); ++s) {
      const bool is_settled = ways.is_settled[s.value()];
      if (!ways.is_explained[s.value()] || (!is_settled && !fit_.domain().is_exact())) continue;
      const auto choices = fit_.mdp(m).choices(s);
      for (std::size_t c = 0; c < choices.size(); ++c) {
        const auto half_space = fit_.gain(m, s.value(), ways.counts, ways.choice[s.value()], c);
        // What is unknown counts the same on both ways if the other one leads there, too.
        const auto next = fit_.mdp(m).outcomes(choices[c]).front().next;
        if (!half_space || (!is_settled && !passes(ways, next, unknown_after(ways, s)))) continue;
        take(*half_space, {ways.mdp, s});
        if (fit_.takes(m, s.value(), c)) shown_.ties.push_back(*half_space);
      }
    }
  }

  // Takes what excludes weights under which something else would be better; whether there is anything.
  bool look_at(const KnownWays& ways, const Weights& w) {
    const auto scale = fit_.domain().count_scale();
    planned_ += ways.choice.size();
    if (planned_ > kMostVerified) return false;
    const auto plan = behave(fit_.domain().mdp(ways.mdp), w, {.scale = scale});
    bool has_changed = false;
    for (StateIndex s{0}; plan && s.value() < ways.choice.size(); ++s) {
      if (!ways.is_settled[s.value()] || !ways.is_explained[s.value()]) continue;
      const auto half_space = preference(ways.counts[s.value()] - plan->counts[s.value()], scale);
      const double least = fit_.domain().is_exact() ? kExplainTolerance : kRounding;
      if (half_space && margin_of(*half_space, w) < -least)
        has_changed = take(*half_space, {ways.mdp, s}) || has_changed;
    }
    return has_changed;
  }

  // Whether it says more than was known. Half-spaces that leave no interior, because the robot takes one of two that
  // are as good, say nothing about a direction.
  bool take(const HalfSpace& half_space, StartId state) {
    shown_.shown_by[half_space].insert(state);
    return !shown_.region.implies(half_space) && shown_.region.clip(half_space);
  }

  const PolicyFit& fit_;
  const Look& look_;
  ShownRegion shown_;
  std::size_t planned_ = 0;
};

}  // namespace

ShownRegion shown_region(const PolicyFit& fit, const Look& look, const Cone& prior) {
  return RegionBuilder{fit, look, prior}.build();
}

std::size_t ShownRegion::support_of(const HalfSpace& facet) const {
  const auto at = shown_by.find(facet);
  return at == shown_by.end() ? 0 : at->second.size();
}

std::optional<Weights> ShownRegion::with_ties() const {
  IntegerVector sum(region.dimension());
  for (const IntegerVector& ray : region.generators()) {
    if (std::ranges::all_of(ties, [&](const HalfSpace& tie) { return sign_of_dot(tie.normal(), ray) == 0; }))
      sum += ray;
  }
  if (ties.empty() || sum.is_zero()) return std::nullopt;
  return as_real(primitive(sum));
}

}  // namespace kith::detail
