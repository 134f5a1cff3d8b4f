#include "kith/teaching/start_sample.hpp"

#include <algorithm>

#include "kith/core/stream.hpp"
#include "kith/core/vector_clones.hpp"

namespace kith {
namespace {

constexpr std::size_t kStarts = 60;
constexpr std::size_t kStartsPerFacet = 6;
constexpr double kSlack = 1e-9;  // in the sine of the angle to a boundary, where paths are equally good

// At most so many of them, each as likely as any other, ascending.
std::vector<StartIndex> some_of(std::vector<StartIndex> starts, std::size_t most, const RandomStream& random) {
  if (starts.size() <= most) return starts;
  const auto chance = [&](StartIndex start) { return random.split(start.value()).address(); };
  std::nth_element(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(most), starts.end(),
                   [&](StartIndex a, StartIndex b) { return chance(a) < chance(b); });
  starts.resize(most);
  std::sort(starts.begin(), starts.end());
  return starts;
}

RandomStream sample_stream() { return RandomStream{0}.split("starts of a component"); }

KITH_VECTOR_CLONES void mark_negative(const std::vector<double>& products, std::vector<char>& marks) {
  const double* const p = products.data();
  char* const m = marks.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < marks.size(); ++i) m[i] = static_cast<char>(p[i] >= -kSlack ? 0 : 1);
}

KITH_VECTOR_CLONES void add_all(const std::vector<char>& marks, std::vector<char>& sum) {
  const char* const m = marks.data();
  char* const s = sum.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < sum.size(); ++i) s[i] = static_cast<char>(s[i] | m[i]);
}

}  // namespace

StartSample StartSample::spread_over_starts(const Atlas& atlas, std::size_t component) {
  const auto& uses_mdp = atlas.knowledge_components()[component].uses_mdp;
  std::vector<StartIndex> starts;
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (atlas.is_candidate(start) && uses_mdp[atlas.id(start).mdp.value()]) starts.push_back(start);
  }
  starts = some_of(std::move(starts), kStarts, sample_stream());
  StartSample sample;
  for (const auto start : starts) sample.add(atlas, start, 1.0);
  sample.finish(atlas);
  return sample;
}

StartSample StartSample::spread_over_facets(const Atlas& atlas, std::size_t component) {
  const auto& taught = atlas.knowledge_components()[component];
  StartSample sample;
  for (const auto facet : taught.constraints.members()) {
    std::vector<StartIndex> starts;
    for (const auto start : atlas.tests_for(facet)) {
      if (taught.uses_mdp[atlas.id(start).mdp.value()]) starts.push_back(start);
    }
    starts = some_of(std::move(starts), kStartsPerFacet, sample_stream());
    for (const auto start : starts) sample.add(atlas, start, 1.0 / static_cast<double>(starts.size()));
  }
  sample.finish(atlas);
  return sample;
}

void StartSample::add(const Atlas& atlas, StartIndex start_index, double weight) {
  const auto known =
      std::find_if(starts_.begin(), starts_.end(), [&](const Start& one) { return one.index == start_index; });
  if (known != starts_.end()) {
    known->weight += weight;
    return;
  }
  auto& start = starts_.emplace_back();
  start.index = start_index;
  start.weight = weight;
  for (const auto c : atlas.tested_constraints(start_index).members()) {
    const auto at = std::find(constraints_.begin(), constraints_.end(), c);
    start.cell.push_back(static_cast<std::uint32_t>(at - constraints_.begin()));
    if (at == constraints_.end()) constraints_.push_back(c);
  }
}

void StartSample::finish(const Atlas& atlas) {
  double sum = 0.0;
  for (const auto& start : starts_) sum += start.weight;
  for (auto& start : starts_) start.weight /= sum;
  for (const auto c : constraints_) half_spaces_.push_back(atlas.constraints()[c]);
  constraints_.clear();
}

// Per half-space the points that do not satisfy it: 1, else 0.
std::vector<std::vector<char>> StartSample::misses(std::span<const std::span<const double>> axes) const {
  const std::size_t n = axes.empty() ? 0 : axes.front().size();
  std::vector<std::vector<char>> result;
  std::vector<double> products(n);
  for (const auto& half_space : half_spaces_) {
    products.assign(n, 0.0);
    const auto normal = half_space.unit();
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const double entry = normal[static_cast<Eigen::Index>(k)];
      if (entry == 0.0) continue;
      for (std::size_t i = 0; i < n; ++i) products[i] += entry * axes[k][i];
    }
    mark_negative(products, result.emplace_back(n, char{0}));
  }
  return result;
}

std::vector<double> StartSample::share_right(std::span<const std::span<const double>> axes) const {
  const std::size_t n = axes.empty() ? 0 : axes.front().size();
  std::vector<double> result(n, starts_.empty() ? 1.0 : 0.0);
  const auto missed = misses(axes);
  std::vector<char> wrong;
  for (const auto& start : starts_) {
    wrong.assign(n, 0);
    for (const auto h : start.cell) add_all(missed[h], wrong);
    for (std::size_t i = 0; i < n; ++i) result[i] += wrong[i] != 0 ? 0.0 : start.weight;
  }
  return result;
}

std::vector<double> StartSample::probabilities_right(const ParticleBelief& belief) const {
  std::vector<std::span<const double>> axes;
  for (std::size_t k = 0; k < belief.dimension(); ++k) axes.push_back(belief.axis(k));
  const auto missed = misses(axes);
  const auto weights = belief.weights();
  std::vector<double> result;
  std::vector<char> wrong;
  for (const auto& start : starts_) {
    wrong.assign(weights.size(), 0);
    for (const auto h : start.cell) add_all(missed[h], wrong);
    double mass = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) mass += wrong[i] != 0 ? 0.0 : weights[i];
    result.push_back(std::min(mass, 1.0));
  }
  return result;
}

double StartSample::share_right(const ParticleBelief& belief) const {
  const auto right = probabilities_right(belief);
  double sum = starts_.empty() ? 1.0 : 0.0;
  for (std::size_t s = 0; s < right.size(); ++s) sum += starts_[s].weight * right[s];
  return std::min(sum, 1.0);
}

}  // namespace kith
