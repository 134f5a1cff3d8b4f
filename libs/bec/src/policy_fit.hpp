#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <unordered_set>
#include <vector>

#include "kith/bec/inference.hpp"
#include "kith/mdp/behaviour.hpp"

// How well reward weights explain what a robot does.
namespace kith::detail {

inline constexpr double kExplainTolerance = 1e-9;  // as that of behave()
inline constexpr std::uint32_t kNoChoice = 0xFFFFFFFF;

using Weights = std::vector<double>;  // shape [d]

[[nodiscard]] Weights at_length_1(Weights w);
// The product of the unit normal and the weights; of a region the least of its facets', 1 without any.
[[nodiscard]] double margin_of(const HalfSpace& half_space, const Weights& w);
[[nodiscard]] double margin_of(const Cone& region, const Weights& w);

// How well some weights explain the policy, and what is best under them.
struct Look {
  Weights weights;
  double share = -1.0;  // < 0: there is no finite optimum
  double loss = 0.0;
  std::vector<Behaviour> plans;  // per MDP

  [[nodiscard]] bool is_better_than(const Look& other) const {
    return share != other.share ? share > other.share : loss < other.loss;
  }
};

// A policy, as weights are held against it. Refers to domain and policy.
class PolicyFit {
 public:
  // Throws std::invalid_argument unless the policy has the domain's shape and some state was seen.
  PolicyFit(const Domain& domain, const ObservedPolicy& policy);

  [[nodiscard]] const Domain& domain() const { return domain_; }
  [[nodiscard]] const Mdp& mdp(std::size_t m) const { return domain_.mdp(MdpIndex{m}); }
  [[nodiscard]] bool is_seen(std::size_t m, std::size_t s) const { return policy_.is_seen[m][s]; }
  // Per state of an MDP what the robot does most often, a position in choices; or kNoChoice. Where it has one choice it
  // takes that, seen or not.
  [[nodiscard]] const std::vector<std::uint32_t>& likeliest(std::size_t m) const { return likeliest_[m]; }
  [[nodiscard]] std::size_t num_states() const { return num_states_; }
  [[nodiscard]] std::size_t num_seen() const { return num_seen_; }
  // How many different behaviours were looked at.
  [[nodiscard]] std::size_t num_behaviours() const { return behaviours_.size(); }

  [[nodiscard]] Look looked_at(Weights weights);
  // What makes a choice as good as all others, if what comes after it counts so much.
  [[nodiscard]] std::vector<HalfSpace> demands(std::size_t m, std::size_t s, const std::vector<IntegerVector>& counts,
                                               std::size_t taken) const;
  // What makes it as good as one other; nothing if both count the same.
  [[nodiscard]] std::optional<HalfSpace> gain(std::size_t m, std::size_t s, const std::vector<IntegerVector>& counts,
                                              std::size_t taken, std::size_t other) const;
  // Whether the robot was seen to take a choice.
  [[nodiscard]] bool takes(std::size_t m, std::size_t s, std::size_t choice) const;
  // The return of a choice if everything after it is best. @param w  at length 1.
  [[nodiscard]] double worth(const Look& look, std::size_t m, const Weights& w, const Choice& choice) const;
  [[nodiscard]] bool is_best(const Look& look, std::size_t m, std::size_t s, std::uint32_t choice) const;
  [[nodiscard]] bool is_explained(const Look& look, std::size_t m, std::size_t s) const;
  [[nodiscard]] bool explains_all_likeliest(const Look& look) const;
  // Of what the robot does in a state: the share that is best, and what the rest gives away.
  struct Part {
    double share = 0.0;
    double loss = 0.0;
  };
  [[nodiscard]] Part explained_at(const Look& look, std::size_t m, std::size_t s, const Weights& w) const;

 private:
  const Domain& domain_;
  const ObservedPolicy& policy_;
  std::vector<std::vector<std::uint32_t>> likeliest_;
  std::size_t num_states_ = 0;
  std::size_t num_seen_ = 0;
  std::unordered_set<std::uint64_t> behaviours_;
};

// What the choices that some weights explain show about the weights.
struct ShownRegion {
  // All weights that explain them or, where the robot's way leads on through states in which it was not seen, a region
  // that holds all of these.
  Cone region;
  std::map<HalfSpace, std::set<StartId>> shown_by;  // the states that show a half-space
  std::vector<HalfSpace> ties;  // what the choices that the robot takes most often gain over others that it takes

  // How many states show a facet; 0 if everybody knows it.
  [[nodiscard]] std::size_t support_of(const HalfSpace& facet) const;
  // Weights of the region under which everything that the robot does in one state is equally good; nothing without
  // ties.
  [[nodiscard]] std::optional<Weights> with_ties() const;
};
[[nodiscard]] ShownRegion shown_region(const PolicyFit& fit, const Look& look, const Cone& prior);

// Tells of the fit what a WeightInference says besides weights and region: the states that are not explained, what
// they clash with, the sides of the region, and the starts that are left out.
void describe_fit(const PolicyFit& fit, const Look& look, const ShownRegion& shown, WeightInference& result);

}  // namespace kith::detail
