#include "policy_evaluation.hpp"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>

#include "kith/core/error.hpp"

namespace kith::detail {
namespace {

constexpr double kMostUnits = 9007199254740992.0;  // 2^53, up to which doubles count exactly
constexpr int kMostSweeps = 200;
constexpr double kStill = 1e-14;  // largest change, relative to the largest value

Eigen::Index eigen_index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

Policy make_policy(const Mdp& mdp, std::vector<std::uint32_t> choice) {
  Policy policy{std::move(choice), {}};
  policy.finishing.reserve(mdp.num_states());
  std::vector<unsigned char> listed(mdp.num_states(), 0);
  const auto list_arrivals = [&](StateIndex next) {
    for (const Arrival& arrival : mdp.arrivals(next)) {
      const std::size_t from = arrival.from.value();
      if (listed[from] != 0 || arrival.choice != policy.choice[from]) continue;
      listed[from] = 1;
      policy.finishing.push_back(static_cast<std::uint32_t>(from));
    }
  };
  for (std::size_t t = 0; t < mdp.num_terminals(); ++t) list_arrivals(StateIndex{mdp.num_states() + t});
  for (std::size_t i = 0; i < policy.finishing.size(); ++i) list_arrivals(StateIndex{policy.finishing[i]});
  return policy;
}

PolicyChain::PolicyChain(const Mdp& mdp, const Policy& policy, std::span<const double> immediate, std::size_t kinds)
    : kinds_{kinds}, order_{policy.finishing} {
  constexpr std::uint32_t kUnlisted = 0xFFFFFFFFu;
  std::vector<std::uint32_t> position(mdp.num_states(), kUnlisted);
  for (std::size_t at = 0; at < order_.size(); ++at) position[order_[at]] = static_cast<std::uint32_t>(at);
  for (std::uint32_t s = 0; s < position.size(); ++s) {
    if (position[s] != kUnlisted) continue;
    position[s] = static_cast<std::uint32_t>(order_.size());
    order_.push_back(s);
  }
  first_link_.reserve(order_.size() + 1);
  first_link_.push_back(0);
  constant_.reserve(immediate.size());
  for (const std::uint32_t s : order_) {
    const auto& choice = mdp.choices(StateIndex{s})[policy.choice[s]];
    constant_.insert(constant_.end(), &immediate[s * kinds], &immediate[s * kinds] + kinds);
    append_row(mdp, s, choice, position);
  }
}

// @pre the constants of the row are the last ones so far.
void PolicyChain::append_row(const Mdp& mdp, std::uint32_t s, const Choice& choice,
                             std::span<const std::uint32_t> position) {
  double staying = 0.0;
  for (const Outcome& outcome : mdp.outcomes(choice)) {
    const double weight = mdp.discount() * outcome.probability;
    if (outcome.next.value() == s) {
      staying += weight;
    } else if (!mdp.is_terminal(outcome.next)) {
      links_.push_back({position[outcome.next.value()], weight});
    }
  }
  const double leaving = 1.0 - staying;
  for (std::size_t l = first_link_.back(); l < links_.size(); ++l) links_[l].weight /= leaving;
  for (std::size_t k = constant_.size() - kinds_; k < constant_.size(); ++k) constant_[k] /= leaving;
  first_link_.push_back(static_cast<std::uint32_t>(links_.size()));
}

bool PolicyChain::sweep(int most_sweeps, std::span<double> values) const {
  std::vector<double> x(constant_.size());
  for (std::size_t at = 0; at < order_.size(); ++at) std::copy_n(&values[order_[at] * kinds_], kinds_, &x[at * kinds_]);

  std::vector<double> sum(kinds_);
  bool is_still = false;
  for (int i = 0; i < most_sweeps && !is_still; ++i) {
    double largest_change = 0.0;
    double largest = 1.0;
    for (std::size_t at = 0; at < order_.size(); ++at) {
      std::copy_n(&constant_[at * kinds_], kinds_, sum.begin());
      for (std::size_t l = first_link_[at]; l < first_link_[at + 1]; ++l) {
        const Link& link = links_[l];
        for (std::size_t k = 0; k < kinds_; ++k) sum[k] += link.weight * x[link.next * kinds_ + k];
      }
      for (std::size_t k = 0; k < kinds_; ++k) {
        double& value = x[at * kinds_ + k];
        largest_change = std::max(largest_change, std::abs(sum[k] - value));
        largest = std::max(largest, std::abs(sum[k]));
        value = sum[k];
      }
    }

    is_still = largest_change <= kStill * largest;
  }

  for (std::size_t at = 0; at < order_.size(); ++at) std::copy_n(&x[at * kinds_], kinds_, &values[order_[at] * kinds_]);
  return is_still;
}

bool PolicyChain::solve(std::span<double> values) const { return sweep(kMostSweeps, values) || factorise(values); }

bool PolicyChain::factorise(std::span<double> values) const {
  using Matrix = Eigen::SparseMatrix<double>;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(order_.size() + links_.size());
  Eigen::MatrixXd constant(eigen_index(order_.size()), eigen_index(kinds_));
  for (std::size_t at = 0; at < order_.size(); ++at) {
    const int row = static_cast<int>(at);
    entries.emplace_back(row, row, 1.0);
    for (std::size_t l = first_link_[at]; l < first_link_[at + 1]; ++l) {
      entries.emplace_back(row, static_cast<int>(links_[l].next), -links_[l].weight);
    }
    for (std::size_t k = 0; k < kinds_; ++k) constant(row, eigen_index(k)) = constant_[at * kinds_ + k];
  }

  Matrix system(eigen_index(order_.size()), eigen_index(order_.size()));
  system.setFromTriplets(entries.begin(), entries.end());
  system.makeCompressed();
  Eigen::SparseLU<Matrix> lu;
  lu.compute(system);
  if (lu.info() != Eigen::Success) return false;
  Eigen::MatrixXd x = lu.solve(constant);
  const Eigen::MatrixXd residual = constant - system * x;
  const Eigen::MatrixXd correction = lu.solve(residual);  // one step of iterative refinement
  x += correction;
  if (!x.allFinite()) return false;
  for (std::size_t at = 0; at < order_.size(); ++at) {
    for (std::size_t k = 0; k < kinds_; ++k) values[order_[at] * kinds_ + k] = x(eigen_index(at), eigen_index(k));
  }
  return true;
}

// sum_up() with a number of kinds that the compiler may know.
template <typename Kinds>
void PathWalk::sum_up_kinds(std::span<const std::uint32_t> states, const PathSteps& steps,
                            std::span<const double> row_counts, Kinds kinds, double discount,
                            std::span<double> values) {
  const std::size_t n = marks_.size();
  for (const std::uint32_t s : states) marks_[s] = Mark::kNew;
  for (const std::uint32_t start : states) {
    std::uint32_t s = start;
    for (; s < n && marks_[s] == Mark::kNew; s = steps.next[s]) {
      marks_[s] = Mark::kOnWalk;
      walk_.push_back(s);
    }
    if (s < n && marks_[s] == Mark::kOnWalk) {  // the walk has met itself
      auto first = walk_.size() - 1;
      while (walk_[first] != s) --first;
      double* const round = &values[s * kinds];
      std::fill_n(round, std::size_t{kinds}, 0.0);
      double share = 1.0;
      for (auto at = first; at < walk_.size(); ++at) {
        for (std::size_t k = 0; k < kinds; ++k) round[k] += share * row_counts[steps.row[walk_[at]] * kinds + k];
        share *= discount;
      }
      for (std::size_t k = 0; k < kinds; ++k) round[k] /= 1.0 - share;
      marks_[s] = Mark::kKnown;
    }
    for (; !walk_.empty(); walk_.pop_back()) {
      const std::uint32_t from = walk_.back();
      if (marks_[from] == Mark::kKnown) continue;
      marks_[from] = Mark::kKnown;
      const double* const ahead = &values[steps.next[from] * kinds];
      const double* const row = &row_counts[steps.row[from] * kinds];
      for (std::size_t k = 0; k < kinds; ++k) values[from * kinds + k] = row[k] + discount * ahead[k];
    }
  }
}

void PathWalk::sum_up(std::span<const std::uint32_t> states, const PathSteps& steps, std::span<const double> row_counts,
                      std::size_t kinds, double discount, std::span<double> values) {
  if (kinds == 1) {
    sum_up_kinds(states, steps, row_counts, std::integral_constant<std::size_t, 1>{}, discount, values);
  } else {
    sum_up_kinds(states, steps, row_counts, kinds, discount, values);
  }
}

std::vector<double> policy_features(const Mdp& mdp, const Policy& policy) {
  const std::size_t d = mdp.num_features();
  if (mdp.is_deterministic() && mdp.discount() < 1.0) {
    const auto rows = feature_rows(mdp);
    PathSteps steps;
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      const Outcome& outcome = mdp.outcomes(mdp.choices(StateIndex{s})[policy.choice[s]]).front();
      steps.next.push_back(static_cast<std::uint32_t>(outcome.next.value()));
      steps.row.push_back(outcome.feature_row);
    }
    std::vector<std::uint32_t> all(mdp.num_states());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<double> features((mdp.num_states() + mdp.num_terminals()) * d, 0.0);
    PathWalk{all.size()}.sum_up(all, steps, rows, d, mdp.discount(), features);
    return features;
  }

  std::vector<double> immediate(mdp.num_states() * d, 0.0);
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    for (const Outcome& outcome : mdp.outcomes(mdp.choices(StateIndex{s})[policy.choice[s]])) {
      const auto phi = mdp.features(outcome);
      for (std::size_t k = 0; k < d; ++k) immediate[s * d + k] += outcome.probability * phi[k];
    }
  }

  std::vector<double> features((mdp.num_states() + mdp.num_terminals()) * d, 0.0);
  if (!PolicyChain{mdp, policy, immediate, d}.solve(features))
    std::fill_n(features.begin(), immediate.size(), std::numeric_limits<double>::infinity());
  return features;
}

IntegerVector in_units(std::span<const double> features, std::int64_t scale) {
  IntegerVector counts(features.size());
  for (std::size_t k = 0; k < features.size(); ++k) {
    const double units = features[k] * static_cast<double>(scale);
    if (!(std::abs(units) < kMostUnits)) {
      throw Error{ErrorKind::kInfeasible,
                  "some people would expect paths that are too long: expected feature counts must stay below 2^53 "
                  "units of 1/" +
                      std::to_string(scale) + "; make ending likelier, or give a smaller discount"};
    }
    // As std::llround, which is a call.
    const auto whole = static_cast<std::int64_t>(units);
    const double rest = units - static_cast<double>(whole);
    counts[k] = whole + (rest >= 0.5 ? 1 : 0) - (rest <= -0.5 ? 1 : 0);
  }
  return counts;
}

}  // namespace kith::detail
