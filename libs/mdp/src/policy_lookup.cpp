#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "checks.hpp"
#include "component_paths.hpp"
#include "kith/mdp/policy_partition.hpp"
#include "normal_set.hpp"
#include "path_follower.hpp"
#include "path_values.hpp"
#include "policy_partition_body.hpp"

namespace kith {
namespace {

using detail::dot_of;
using detail::NormalSet;

// By how much, relative to the length of the weights, a part's half-spaces must hold: far more than rounding.
constexpr double kClear = 1e-6;
// Discounted counts that differ by less, relative to the largest, differ by rounding alone; normals of parts that
// differ by less are one, because any clearance is far larger.
constexpr double kSame = 1e-13;
constexpr double kSameNormal = 1e-12;
constexpr double kOfIntegers = 0.5;  // tells normals of integers apart

}  // namespace

// What one thread does with a partition: it keeps the memory that a look-up takes.
class PolicyLookup::Body {
 public:
  bool locate(PolicyPartition::Body& known, std::span<const double> weights, bool may_grow) {
    detail::require_weights(known.mdp(), weights, "PolicyLookup");
    known_ = &known;
    weights_ = weights;
    may_grow_ = may_grow;
    grown_by_ = 0;
    rewards_.clear();
    follower_.reset();
    paths_.reset();
    values_.reset();
    planned_.reset();
    loose_.clear();
    key_.clear();
    is_kept_ = true;

    if (!known.has_optima()) return false;
    double square = 0.0;
    for (const double w : weights) square += w * w;
    places_.resize(std::max(places_.size(), known.num_components()));

    if (known.is_discounted()) return locate_discounted();
    clear_by_ = kClear * std::sqrt(square);
    if (known.gains(weights, clear_by_)) return false;

    for (std::size_t c = 0; c < known.num_components(); ++c) {
      if (!(known.is_alone(c) ? step(c) : enter(c))) return false;
    }
    if (!is_kept_) key_.clear();
    return true;
  }

  [[nodiscard]] IntegerVector counts(std::size_t i) const {
    const StateIndex s = known_->states()[i];
    if (planned_) return planned_->counts[s.value()];
    if (known_->is_discounted()) {
      return detail::in_units({expected_at(s.value()), known_->mdp().num_features()}, known_->options().scale);
    }
    auto result = counts_at(s.value());
    for (std::size_t k = 0; k < result.size(); ++k) result[k] *= known_->options().scale;
    return result;
  }

  [[nodiscard]] std::span<const std::uint32_t> key() const noexcept { return key_; }
  [[nodiscard]] std::size_t grown_by() const noexcept { return grown_by_; }

 private:
  using Part = PolicyPartition::Body::Part;
  using Expected = std::array<double, IntegerVector::kMaxDimension>;  // the first d entries, the others 0
  // Where the weights of the last locate() lie in a component.
  struct Place {
    const Part* part = nullptr;
    IntegerVector base;  // the counts of the first exit, or of the only state
    Expected alone{};    // those of the only state of a discounted component
  };

  // Of a state that matters, in a component that was located.
  [[nodiscard]] IntegerVector counts_at(std::size_t s) const {
    if (s >= known_->mdp().num_states()) return IntegerVector(known_->mdp().num_features());
    const auto& place = places_[known_->component_of(s)];
    auto result = place.base;
    if (place.part == nullptr) return result;
    const std::size_t d = known_->mdp().num_features();
    const std::int64_t* const own = &place.part->counts[known_->kept_place(s) * d];
    for (std::size_t k = 0; k < d; ++k) result[k] += own[k];
    return result;
  }

  // By how much half-spaces must hold where counts reach so far: then a choice is clearly better than another one.
  [[nodiscard]] double clearance(double largest_value) const {
    return std::max(clear_by_, 4.0 * known_->options().tolerance * std::max(1.0, largest_value));
  }

  // A component of one state: its best choice.
  bool step(std::size_t c) {
    const StateIndex s = known_->members(c).front();
    const auto choices = known_->mdp().choices(s);
    ways_.clear();
    double best = 0.0;
    for (const Choice& choice : choices) {
      const Outcome& outcome = known_->mdp().outcomes(choice).front();
      auto& way = ways_.emplace_back(counts_at(outcome.next.value()), 0.0);
      way.first += known_->mdp().integer_features(outcome);
      way.second = dot(way.first, weights_);
      best = ways_.size() == 1 ? way.second : std::max(best, way.second);
    }

    // Of those that are best, the one that earns the robot most; the first of equals.
    std::optional<std::size_t> chosen;
    double earned = 0.0;
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      if (!detail::is_tight(best, ways_[i].second, known_->options().tolerance)) continue;
      const double robots = dot(ways_[i].first, known_->robot());
      if (chosen && robots <= earned + known_->options().tolerance * std::max(1.0, std::abs(earned))) continue;
      chosen = i;
      earned = robots;
    }

    // Where another way is nearly as good, what is best here does not follow from what is kept.
    for (std::size_t i = 0; i < ways_.size() && is_kept_; ++i) {
      is_kept_ = ways_[i].second < best - clearance(std::abs(best)) || ways_[i].first == ways_[*chosen].first;
    }

    places_[c] = {nullptr, ways_[*chosen].first};
    key_.push_back(static_cast<std::uint32_t>(*chosen));
    return true;
  }

  // A component of several states: the part that the weights lie in, if it is known, else a plan.
  bool enter(std::size_t c) {
    const auto exits = known_->exits(c);
    const IntegerVector base = counts_at(exits.front());
    differences_.clear();
    for (std::size_t e = 1; e < exits.size(); ++e) {
      const auto difference = counts_at(exits[e]) - base;
      differences_.insert(differences_.end(), difference.begin(), difference.end());
    }
    const Part* const part = known_->candidate(c, differences_, weights_);
    if (part == nullptr || !holds(*part)) return plan(c, base);
    places_[c] = {part, base};
    key_.push_back(part->number);
    return true;
  }

  [[nodiscard]] bool holds(const Part& part) const {
    const std::size_t d = weights_.size();
    double largest = 0.0;
    for (std::size_t k = 0; k < d; ++k) largest += part.reach[k] * std::abs(weights_[k]);
    const double least = clearance(largest);
    for (std::size_t i = 0; i < part.normals.size(); i += d) {
      if (!(dot_of(&part.normals[i], weights_) > least)) return false;
    }
    return true;
  }

  bool plan(std::size_t c, const IntegerVector& base) {
    if (rewards_.empty()) {
      rewards_ = detail::row_rewards(known_->mdp(), weights_);
      paths_.emplace(known_->mdp(), rewards_, known_->options().tolerance);
      follower_.reset();
      // Whatever is read of it later is written before.
      const std::size_t size = known_->mdp().num_states() + known_->mdp().num_terminals();
      if (!counts_.empty() && counts_.front().size() != weights_.size()) counts_.clear();
      if (counts_.size() < size) counts_.resize(size, IntegerVector(weights_.size()));
    }
    for (const std::uint32_t exit : known_->exits(c)) {
      counts_[exit] = counts_at(exit) - base;
      paths_->set_value(StateIndex{exit}, dot(counts_[exit], weights_));
    }
    const auto found = paths_->solve_component(c);
    if (found == detail::PathsFound::kPositiveCycle) {
      keep_gain(paths_->cycle_features());
      return false;
    }
    if (found == detail::PathsFound::kTightCycle) return false;
    if (!follower_) follower_.emplace(known_->mdp(), rewards_, paths_->values(), known_->options().tolerance);
    for (const StateIndex s : known_->members(c)) follower_->find_step(s.value());
    for (const std::uint32_t s : paths_->order()) follower_->follow(s, known_->robot(), counts_);
    places_[c] = {keep(c), base};
    return true;
  }

  // A discounted process always has an optimum. If in some component nothing is clearly best, it is planned as a whole.
  bool locate_discounted() {
    clear_by_ = 0.0;
    for (std::size_t c = 0; c < known_->num_components(); ++c) {
      if (known_->is_alone(c) ? step_discounted(c) : enter_discounted(c)) continue;
      key_.clear();
      planned_ = behave_in_favour(known_->mdp(), weights_, known_->robot(), known_->options());
      return planned_.has_value();
    }
    if (!is_kept_) key_.clear();
    return true;
  }

  // Expected counts of a state that matters, in a component that was located.
  [[nodiscard]] const double* expected_at(std::size_t s) const {
    if (s >= known_->mdp().num_states()) return kNothing.data();
    const auto& place = places_[known_->component_of(s)];
    if (place.part == nullptr) return place.alone.data();
    return &place.part->expected[known_->kept_place(s) * known_->mdp().num_features()];
  }

  // `counts` less what a choice counts, given what the state that it leads to counts.
  [[nodiscard]] Expected less(const double* counts, std::size_t choice, const double* next) const {
    const Mdp& mdp = known_->mdp();
    const double* const phi = mdp.feature_row(known_->steps().row[choice]).data();
    Expected result{};
    for (std::size_t k = 0; k < weights_.size(); ++k) result[k] = counts[k] - phi[k] - mdp.discount() * next[k];
    return result;
  }

  // Whether counts differ, as a loss tells, by more than rounding. @param largest  count.
  static bool differs(const Expected& loss, double largest) {
    return std::any_of(loss.begin(), loss.end(), [&](double x) { return std::abs(x) > kSame * largest; });
  }

  // A component of one state. False unless its best choice is clearly so.
  bool step_discounted(std::size_t c) {
    const Mdp& mdp = known_->mdp();
    const auto& steps = known_->steps();
    const StateIndex s = known_->members(c).front();
    const std::size_t first = mdp.first_choice(s), last = first + mdp.choices(s).size();
    const auto negative_counts = [&](std::size_t i) { return less(kNothing.data(), i, expected_at(steps.next[i])); };

    std::size_t chosen = first;
    double least = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      const double cost = dot_of(negative_counts(i).data(), weights_);
      if (i > first && !(cost < least)) continue;
      least = cost;
      chosen = i;
    }

    auto& own = places_[c].alone;
    own = negative_counts(chosen);
    double largest = 1.0, reach = 0.0;
    for (std::size_t k = 0; k < weights_.size(); ++k) {
      own[k] = -own[k];
      largest = std::max(largest, std::abs(own[k]));
      reach += std::abs(own[k] * weights_[k]);
    }

    const double clear_by = clearance(reach);
    std::size_t first_equal = chosen;
    for (std::size_t i = first; i < last; ++i) {
      const auto loss = less(own.data(), i, expected_at(steps.next[i]));
      if (!differs(loss, largest)) {
        first_equal = std::min(first_equal, i);
      } else if (!(dot_of(loss.data(), weights_) > clear_by)) {
        return false;
      }
    }

    if (first_equal != chosen) {
      own = negative_counts(first_equal);
      for (double& x : own) x = -x;
    }
    places_[c].part = nullptr;
    key_.push_back(static_cast<std::uint32_t>(first_equal - first));
    return true;
  }

  // A component of several states. False unless its best choices are clearly so.
  bool enter_discounted(std::size_t c) {
    differences_.clear();
    for (const std::uint32_t exit : known_->exits(c)) {
      if (exit >= known_->mdp().num_states()) continue;
      const double* const counts = expected_at(exit);
      for (std::size_t k = 0; k < weights_.size(); ++k) differences_.push_back(std::bit_cast<std::int64_t>(counts[k]));
    }
    const Part* part = known_->candidate(c, differences_, weights_);
    if (part == nullptr || !holds(*part)) {
      part = plan_discounted(c);
    } else {
      key_.push_back(part->number);
    }
    places_[c].part = part;
    return part != nullptr;
  }

  const Part* plan_discounted(std::size_t c) {
    const Mdp& mdp = known_->mdp();
    const auto& steps = known_->steps();
    const std::size_t d = weights_.size();
    if (!values_) {
      rewards_ = detail::row_rewards(mdp, weights_);
      values_.emplace(mdp, steps, rewards_, known_->options().tolerance, all_);
      expected_.resize(std::max(expected_.size(), (mdp.num_states() + mdp.num_terminals()) * d));
      std::fill_n(expected_.begin() + static_cast<std::ptrdiff_t>(mdp.num_states() * d), mdp.num_terminals() * d, 0.0);
    }

    for (const std::uint32_t exit : known_->exits(c)) {
      const double* const counts = expected_at(exit);
      std::copy_n(counts, d, &expected_[exit * d]);
      values_->set_value(exit, dot_of(counts, weights_));
    }

    values_->solve(known_->by_distance(c));
    values_->take_first_tight(known_->by_distance(c));
    values_->sum_up(known_->by_distance(c), detail::feature_rows(mdp), d, expected_);

    auto part = std::make_unique<Part>();
    std::vector<double> sum(d, 0.0);
    if (!bound_discounted(c, *part, sum)) return nullptr;
    for (const std::uint32_t s : known_->kept(c)) {
      part->expected.insert(part->expected.end(), &expected_[s * d], &expected_[s * d] + d);
    }
    return may_grow_ && is_kept_ ? keep(c, std::move(part), sum) : leave(std::move(part));
  }

  // The half-spaces that the counts in `expected_` follow from, and their sum over all states. Choices that count the
  // same as that of the plan are no different. False unless all half-spaces hold clearly.
  [[nodiscard]] bool bound_discounted(std::size_t c, Part& part, std::vector<double>& sum) const {
    const Mdp& mdp = known_->mdp();
    const auto& steps = known_->steps();
    const std::size_t d = weights_.size();

    part.reach.assign(d, 0.0);
    std::size_t num_choices = 0;
    for (const StateIndex s : known_->members(c)) {
      num_choices += mdp.choices(s).size();
      for (std::size_t k = 0; k < d; ++k) {
        part.reach[k] = std::max(part.reach[k], std::abs(expected_[s.value() * d + k]));
        sum[k] += expected_[s.value() * d + k];
      }
    }

    const double largest = std::max(1.0, *std::max_element(part.reach.begin(), part.reach.end()));
    NormalSet normals{d, kSameNormal * largest, num_choices};
    for (const StateIndex s : known_->members(c)) {
      const std::size_t first = mdp.first_choice(s);
      for (std::size_t i = first; i < first + mdp.choices(s).size(); ++i) {
        const auto loss = less(&expected_[s.value() * d], i, &expected_[steps.next[i] * d]);
        if (differs(loss, largest)) normals.insert(loss.data());
      }
    }

    part.normals = normals.by_margin(weights_);
    return holds(part);
  }

  // A cycle that earns, unless it hardly earns anything.
  void keep_gain(const IntegerVector& features) {
    if (may_grow_ && dot(features, weights_) > clear_by_) grown_by_ += known_->add_gain(primitive(features));
  }

  // The part of what was planned last, with the differences in `differences_`.
  const Part* keep(std::size_t c) {
    const std::size_t d = weights_.size();
    auto part = std::make_unique<Part>();
    for (const std::uint32_t s : known_->kept(c)) {
      part->counts.insert(part->counts.end(), counts_[s].begin(), counts_[s].end());
    }
    if (!may_grow_ || !is_kept_ || !bound(c, *part)) return leave(std::move(part));
    std::vector<double> sum(d, 0.0);
    for (const StateIndex s : known_->members(c)) {
      for (std::size_t k = 0; k < d; ++k) sum[k] += static_cast<double>(counts_[s.value()][k]);
    }
    return keep(c, std::move(part), sum);
  }

  const Part* keep(std::size_t c, std::unique_ptr<Part> part, std::span<const double> sum) {
    const auto [kept, bytes] = known_->add(c, differences_, weights_, std::move(part), sum,
                                           [this](const Part& other) { return holds(other); });
    grown_by_ += bytes;
    key_.push_back(kept->number);
    return kept;
  }

  // For this look-up alone.
  const Part* leave(std::unique_ptr<Part> part) {
    is_kept_ = false;
    return loose_.emplace_back(std::move(part)).get();
  }

  // The half-spaces that the plan in `counts_` follows from. False unless all hold clearly.
  [[nodiscard]] bool bound(std::size_t c, Part& part) {
    const std::size_t d = weights_.size();
    part.reach.assign(d, 0.0);
    for (const StateIndex s : known_->members(c)) {
      for (std::size_t k = 0; k < d; ++k) {
        part.reach[k] = std::max(part.reach[k], std::abs(static_cast<double>(counts_[s.value()][k])));
      }
    }
    std::size_t num_choices = 0;
    for (const StateIndex s : known_->members(c)) num_choices += known_->mdp().choices(s).size();
    NormalSet met{d, kOfIntegers, num_choices};
    NormalSet normals{d, kOfIntegers, num_choices};
    IntegerVector loss(d);
    std::vector<double> normal(d);
    for (const StateIndex s : known_->members(c)) {
      const std::int64_t* const own = counts_[s.value()].begin();
      for (const Choice& choice : known_->mdp().choices(s)) {
        const Outcome& outcome = known_->mdp().outcomes(choice).front();
        const std::int64_t* const next = counts_[outcome.next.value()].begin();
        const std::int64_t* const phi = known_->mdp().integer_features(outcome).begin();
        std::int64_t is_any = 0;
        for (std::size_t k = 0; k < d; ++k) {
          const std::int64_t x = own[k] - phi[k] - next[k];
          is_any |= x;
          loss[k] = x;
          normal[k] = static_cast<double>(x);
        }
        if (is_any == 0 || !met.insert(normal.data())) continue;
        const auto shortest = primitive(loss);
        std::copy(shortest.begin(), shortest.end(), normal.begin());
        normals.insert(normal.data());
      }
    }
    part.normals = normals.by_margin(weights_);
    return holds(part);
  }

  PolicyPartition::Body* known_ = nullptr;
  std::span<const double> weights_;
  bool may_grow_ = true;
  bool is_kept_ = true;
  double clear_by_ = kClear;
  std::size_t grown_by_ = 0;
  std::vector<Place> places_;  // per component
  std::vector<std::uint32_t> key_;
  std::vector<std::unique_ptr<Part>> loose_;  // parts that are not kept
  std::vector<std::int64_t> differences_;
  std::vector<std::pair<IntegerVector, double>> ways_;
  std::vector<double> rewards_;  // empty until something is planned
  std::optional<detail::ComponentPaths> paths_;
  std::optional<detail::PathFollower> follower_;  // of paths_
  std::vector<IntegerVector> counts_;

  // Of a discounted process.
  static constexpr Expected kNothing{};
  const detail::ChoiceMask all_{};
  std::optional<detail::PathValues> values_;  // empty until something is planned
  std::vector<double> expected_;              // row-major, shape [num_states + num_terminals, d]
  std::optional<Behaviour> planned_;          // where something was not clear
};

PolicyLookup::PolicyLookup() : body_{std::make_unique<Body>()} {}
PolicyLookup::PolicyLookup(PolicyLookup&&) noexcept = default;
PolicyLookup& PolicyLookup::operator=(PolicyLookup&&) noexcept = default;
PolicyLookup::~PolicyLookup() = default;

bool PolicyLookup::locate(PolicyPartition& partition, std::span<const double> weights, bool may_grow) {
  return body_->locate(*partition.body_, weights, may_grow);
}
IntegerVector PolicyLookup::counts(std::size_t i) const { return body_->counts(i); }
std::span<const std::uint32_t> PolicyLookup::key() const noexcept { return body_->key(); }
std::size_t PolicyLookup::grown_by() const noexcept { return body_->grown_by(); }

}  // namespace kith
