#include "kith/mdp/mdp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "checks.hpp"
#include "components.hpp"

namespace kith {
namespace {

using detail::require;

constexpr double kProbabilitySlack = 1e-9;        // in the sum of a row of the transition kernel
constexpr double kLargestInteger = 2147483648.0;  // 2^31, the range of an IntegerVector's entries

bool is_small_integer(double x) { return x == std::floor(x) && std::abs(x) < kLargestInteger; }

std::uint32_t count32(std::size_t n) { return static_cast<std::uint32_t>(n); }

}  // namespace

double Mdp::largest_feature() const noexcept {
  double largest = 0.0;
  for (const double entry : feature_table_) largest = std::max(largest, std::abs(entry));
  return largest;
}

void Mdp::reject(const char* rule) { throw std::invalid_argument{rule}; }

void Mdp::index_arrivals() {
  const std::size_t all_states = num_states() + num_terminals_;
  first_arrival_.assign(all_states + 1, 0);
  for (const Outcome& outcome : outcomes_) ++first_arrival_[outcome.next.value() + 1];
  for (std::size_t s = 0; s < all_states; ++s) first_arrival_[s + 1] += first_arrival_[s];

  arrivals_.resize(outcomes_.size());
  std::vector<std::uint32_t> slot(first_arrival_.begin(), first_arrival_.end() - 1);
  for (std::size_t s = 0; s < num_states(); ++s) {
    const auto legal = choices(StateIndex{s});
    for (std::size_t c = 0; c < legal.size(); ++c) {
      for (const Outcome& outcome : outcomes(legal[c])) {
        arrivals_[slot[outcome.next.value()]++] = {StateIndex{s}, count32(c), outcome.feature_row};
      }
    }
  }
}

void Mdp::order_by_distance() {
  std::vector<bool> seen(num_states(), false);
  const auto visit_arrivals = [&](StateIndex s) {
    for (const Arrival& arrival : arrivals(s)) {
      if (seen[arrival.from.value()]) continue;
      seen[arrival.from.value()] = true;
      by_distance_.push_back(arrival.from);
    }
  };
  by_distance_.reserve(num_states());
  for (std::size_t t = 0; t < num_terminals_; ++t) visit_arrivals(StateIndex{num_states() + t});
  for (std::size_t i = 0; i < by_distance_.size(); ++i) visit_arrivals(by_distance_[i]);
}

void Mdp::group_by_component() {
  detail::Components components = detail::strong_components(*this);
  by_component_ = std::move(components.states);
  component_starts_ = std::move(components.starts);
}

MdpBuilder::MdpBuilder(std::size_t num_states, std::size_t num_terminals, std::size_t num_actions,
                       std::size_t num_features, double discount) {
  require(discount > 0.0 && discount <= 1.0, "MdpBuilder", "the discount must be in (0, 1]");
  require(num_features >= 1 && num_features <= IntegerVector::kMaxDimension, "MdpBuilder",
          "the number of features must be in 1 .. 8");
  static_assert(IntegerVector::kMaxDimension == 8);
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  require(num_states < kMost && num_terminals < kMost - num_states, "MdpBuilder", "there are too many states");
  mdp_.num_terminals_ = num_terminals;
  mdp_.num_actions_ = num_actions;
  mdp_.num_features_ = num_features;
  mdp_.discount_ = discount;
  mdp_.has_feature_.assign(num_features, false);
  mdp_.first_choice_.assign(num_states + 1, 0);
}

void MdpBuilder::add_choice(StateIndex s, ActionIndex action, std::span<const Transition> transitions) {
  constexpr const char* kName = "MdpBuilder::add_choice";
  const std::size_t all_states = mdp_.num_states() + mdp_.num_terminals_;
  require(s.value() < mdp_.num_states(), kName, "only non-terminal states have choices");
  require(action.value() < mdp_.num_actions_, kName, "the action is out of range");
  require(!last_state_ || *last_state_ <= s.value(), kName, "states must come in order");
  require(last_state_ != s.value() || *last_action_ < action.value(), kName, "actions of a state must come in order");
  double sum = 0.0;
  bool leaves = false;
  for (const Transition& transition : transitions) {
    require(transition.next.value() < all_states, kName, "the next state is out of range");
    require(transition.probability > 0.0, kName, "a probability must be positive");
    require(transition.features.size() == mdp_.num_features_, kName, "features have the wrong length");
    require(std::ranges::all_of(transition.features, [](double x) { return std::isfinite(x); }), kName,
            "features must be finite");
    sum += transition.probability;
    leaves = leaves || transition.next != s;
  }
  require(std::abs(sum - 1.0) <= kProbabilitySlack, kName, "probabilities must sum to 1");
  require(leaves, kName, "an action that leaves the state as it is is not a choice");

  mdp_.choices_.push_back({action, count32(mdp_.outcomes_.size()), count32(transitions.size())});
  for (const Transition& transition : transitions) {
    mdp_.outcomes_.push_back({transition.next, transition.probability, row_of(transition.features)});
  }
  mdp_.deterministic_ = mdp_.deterministic_ && transitions.size() == 1;
  mdp_.first_choice_[s.value() + 1] = count32(mdp_.choices_.size());
  last_state_ = s.value();
  last_action_ = action.value();
}

std::uint32_t MdpBuilder::row_of(const std::vector<double>& features) {
  const auto [position, is_new] = rows_.try_emplace(features, count32(rows_.size()));  // -0 and 0 are one row
  if (is_new) {
    for (std::size_t k = 0; k < features.size(); ++k) {
      mdp_.feature_table_.push_back(features[k]);
      mdp_.has_feature_[k] = mdp_.has_feature_[k] || features[k] != 0.0;
      mdp_.integral_ = mdp_.integral_ && is_small_integer(features[k]);
    }
  }
  return position->second;
}

Mdp MdpBuilder::build() && {
  // States without choices, and those after the last one with any, begin where their predecessor ends.
  auto& first = mdp_.first_choice_;
  for (std::size_t s = 1; s < first.size(); ++s) first[s] = std::max(first[s], first[s - 1]);
  mdp_.num_rows_ = rows_.size();
  for (std::size_t row = 0; mdp_.integral_ && row < mdp_.num_rows_; ++row) {
    IntegerVector entries(mdp_.num_features_);
    const auto features = mdp_.feature_row(row);
    for (std::size_t k = 0; k < features.size(); ++k) entries[k] = static_cast<std::int64_t>(features[k]);
    mdp_.integer_table_.push_back(entries);
  }
  mdp_.index_arrivals();
  mdp_.order_by_distance();
  mdp_.group_by_component();
  return std::move(mdp_);
}

}  // namespace kith
