#include "simplicial_fan.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace kith::detail {
namespace {

using Word = std::uint64_t;
using RaySet = std::vector<Word>;

constexpr std::size_t kBits = 64;
constexpr std::size_t kMostCones = 1'000'000;

std::size_t size_of(const RaySet& set) {
  std::size_t sum = 0;
  for (const Word word : set) sum += static_cast<std::size_t>(std::popcount(word));
  return sum;
}

bool has(const RaySet& set, std::size_t ray) { return ((set[ray / kBits] >> (ray % kBits)) & 1) != 0; }

bool is_subset(const RaySet& a, const RaySet& b) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    if ((a[k] & ~b[k]) != 0) return false;
  }
  return true;
}

class Triangulation {
 public:
  Triangulation(std::span<const HalfSpace> facets, std::span<const IntegerVector> rays) : num_rays_{rays.size()} {
    for (const HalfSpace& facet : facets) {
      RaySet set((rays.size() + kBits - 1) / kBits);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (sign_of_dot(facet.normal(), rays[i]) == 0) set[i / kBits] |= Word{1} << (i % kBits);
      }
      facets_.push_back(std::move(set));
    }
  }

  std::vector<std::uint32_t> run(std::size_t rank) {
    RaySet all((num_rays_ + kBits - 1) / kBits, ~Word{0});
    if (num_rays_ % kBits != 0) all.back() = (Word{1} << (num_rays_ % kBits)) - 1;
    pull(all, facets_, rank);
    return std::move(cones_);
  }

 private:
  // `bounds`: the sets of rays of facets, or of faces of them, whose intersections with `face` include its sub-facets.
  void pull(const RaySet& face, const std::vector<RaySet>& bounds, std::size_t rank) {
    if (size_of(face) == rank) {
      if (cones_.size() >= kMostCones * (apexes_.size() + rank)) {
        throw std::length_error{"ConeSampler: the cone has too many faces"};
      }
      cones_.insert(cones_.end(), apexes_.begin(), apexes_.end());
      for (std::size_t i = 0; i < num_rays_; ++i) {
        if (has(face, i)) cones_.push_back(static_cast<std::uint32_t>(i));
      }
      return;
    }
    const std::vector<RaySet> below = sub_facets(face, bounds, rank);
    const std::size_t apex = most_common(below);
    apexes_.push_back(static_cast<std::uint32_t>(apex));
    for (const RaySet& base : below) {
      if (!has(base, apex)) pull(base, below, rank - 1);
    }
    apexes_.pop_back();
  }

  // The largest proper intersections.
  static std::vector<RaySet> sub_facets(const RaySet& face, const std::vector<RaySet>& bounds, std::size_t rank) {
    std::vector<RaySet> candidates;
    for (const RaySet& bound : bounds) {
      RaySet common = face;
      for (std::size_t k = 0; k < common.size(); ++k) common[k] &= bound[k];
      if (common != face && size_of(common) + 1 >= rank) candidates.push_back(std::move(common));
    }
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    std::vector<RaySet> result;
    for (const RaySet& candidate : candidates) {
      const bool is_largest = std::none_of(candidates.begin(), candidates.end(), [&](const RaySet& other) {
        return &other != &candidate && is_subset(candidate, other);
      });
      if (is_largest) result.push_back(candidate);
    }
    return result;
  }

  [[nodiscard]] std::size_t most_common(const std::vector<RaySet>& sets) const {
    std::vector<std::size_t> counts(num_rays_);
    for (const RaySet& set : sets) {
      for (std::size_t k = 0; k < set.size(); ++k) {
        for (Word word = set[k]; word != 0; word &= word - 1) {
          ++counts[k * kBits + static_cast<std::size_t>(std::countr_zero(word))];
        }
      }
    }
    return static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
  }

  std::size_t num_rays_;
  std::vector<RaySet> facets_;
  std::vector<std::uint32_t> apexes_;
  std::vector<std::uint32_t> cones_;
};

}  // namespace

std::vector<std::uint32_t> triangulate(std::span<const HalfSpace> facets, std::span<const IntegerVector> rays,
                                       std::size_t rank) {
  if (rank == 0) return {};
  return Triangulation{facets, rays}.run(rank);
}

}  // namespace kith::detail
