// Cones in other than three dimensions, by the double description method of
// Motzkin and others: facets and generators side by side. The generators
// are lines, which span the largest subspace inside, and one ray for each
// extreme ray modulo the lines. A new half-space c either meets a line, which
// then becomes a ray, the only one off the boundary of c; or it splits the rays
// by the exact sign of c . r: those beyond it go, and each of them leaves one on
// the boundary for every adjacent ray on the near side.
//
// Two rays are adjacent iff no third one lies on all facets that they share.

#include <algorithm>
#include <bit>
#include <utility>

#include "combination.hpp"
#include "exact.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {
namespace {

using detail::combination;
using detail::first_nonzero;
using Word = std::uint64_t;

constexpr std::size_t kBits = 64;

std::size_t words_for(std::size_t facets) { return (facets + kBits - 1) / kBits; }

// Sets of facets, one for each ray, of `words` words each.
class FacetSets {
 public:
  explicit FacetSets(std::size_t facets) : words_{words_for(facets)} {}
  FacetSets(std::vector<Word> sets, std::size_t facets) : words_{words_for(facets)}, sets_{std::move(sets)} {}

  [[nodiscard]] std::size_t words() const { return words_; }
  [[nodiscard]] const Word* operator[](std::size_t i) const { return sets_.data() + i * words_; }
  [[nodiscard]] Word* add() {
    sets_.resize(sets_.size() + words_);
    return sets_.data() + sets_.size() - words_;
  }
  [[nodiscard]] std::vector<Word> take() { return std::move(sets_); }

  [[nodiscard]] std::size_t count(std::size_t i) const {
    std::size_t sum = 0;
    for (std::size_t k = 0; k < words_; ++k) sum += static_cast<std::size_t>(std::popcount((*this)[i][k]));
    return sum;
  }

  [[nodiscard]] std::size_t count_common(std::size_t i, std::size_t j) const {
    std::size_t sum = 0;
    for (std::size_t k = 0; k < words_; ++k) {
      sum += static_cast<std::size_t>(std::popcount((*this)[i][k] & (*this)[j][k]));
    }
    return sum;
  }

  // Whether set `other` has all that i and j share.
  [[nodiscard]] bool has_common(std::size_t other, std::size_t i, std::size_t j) const {
    for (std::size_t k = 0; k < words_; ++k) {
      if (((*this)[i][k] & (*this)[j][k] & ~(*this)[other][k]) != 0) return false;
    }
    return true;
  }

 private:
  std::size_t words_;
  std::vector<Word> sets_;
};

void set_bit(Word* set, std::size_t facet) { set[facet / kBits] |= Word{1} << (facet % kBits); }
bool has_bit(const Word* set, std::size_t facet) { return ((set[facet / kBits] >> (facet % kBits)) & 1) != 0; }

// Whether rays i and j span a two-dimensional face of a cone whose pointed part has `rank` dimensions. They share
// at least rank - 2 facets then; exactly so many suffice if one of the two is simple, that is on rank - 1 facets
// only, since the normals of these are independent.
bool are_adjacent(const FacetSets& tight, std::size_t num_rays, std::size_t i, std::size_t j, std::size_t rank) {
  const std::size_t common = tight.count_common(i, j);
  if (common + 2 < rank) return false;
  if (common + 2 == rank && (tight.count(i) + 1 == rank || tight.count(j) + 1 == rank)) return true;
  for (std::size_t other = 0; other < num_rays; ++other) {
    if (other != i && other != j && tight.has_common(other, i, j)) return false;
  }
  return true;
}

std::size_t size_of(Word set) { return static_cast<std::size_t>(std::popcount(set)); }

// The same where every set is one word.
bool are_adjacent(std::span<const Word> tight, std::size_t i, std::size_t j, std::size_t rank) {
  const Word common = tight[i] & tight[j];
  const std::size_t size = size_of(common);
  if (size + 2 < rank) return false;
  if (size + 2 == rank && (size_of(tight[i]) + 1 == rank || size_of(tight[j]) + 1 == rank)) return true;
  std::size_t num_with_common = 0;  // these two among them
  for (const Word set : tight) {
    num_with_common += (common & ~set) == 0 ? 1u : 0u;
    if (num_with_common > 2) return false;
  }
  return true;
}

// The facets that are left: a former facet is one no more if all rays on it lie on another one as well.
std::vector<std::size_t> facets_left(const FacetSets& tight, std::size_t num_rays, std::size_t num_facets) {
  std::vector<std::size_t> left;
  // Of each facet, what all rays on it share; a facet that no ray meets shares everything.
  const std::size_t words = tight.words();
  std::vector<Word> common(num_facets * words, ~Word{0});
  for (std::size_t i = 0; i < num_rays; ++i) {
    const Word* const set = tight[i];
    for (std::size_t k = 0; k < words; ++k) {
      for (Word rest = set[k]; rest != 0; rest &= rest - 1) {
        Word* const shared = &common[(k * kBits + static_cast<std::size_t>(std::countr_zero(rest))) * words];
        for (std::size_t l = 0; l < words; ++l) shared[l] &= set[l];
      }
    }
  }
  for (std::size_t facet = 0; facet < num_facets; ++facet) {
    std::size_t count = 0;
    for (std::size_t l = 0; l < words; ++l) count += size_of(common[facet * words + l]);
    if (count == 1) left.push_back(facet);
  }
  return left;
}

FacetSets only(const FacetSets& tight, std::size_t num_rays, std::span<const std::size_t> left) {
  FacetSets result{left.size()};
  for (std::size_t i = 0; i < num_rays; ++i) {
    Word* set = result.add();
    for (std::size_t k = 0; k < left.size(); ++k) {
      if (has_bit(tight[i], left[k])) set_bit(set, k);
    }
  }
  return result;
}

// Brings rows into reduced echelon form: the first entry of each is positive and the only one in its column.
void reduce_rows(std::vector<IntegerVector>& rows) {
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return first_nonzero(a) < first_nonzero(b); });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // Of the rows from i on, the one that starts first leads.
    std::size_t leader = i;
    for (std::size_t j = i + 1; j < rows.size(); ++j) {
      if (first_nonzero(rows[j]) < first_nonzero(rows[leader])) leader = j;
    }
    std::swap(rows[i], rows[leader]);
    const std::size_t column = first_nonzero(rows[i]);
    if (rows[i][column] < 0) rows[i] = -rows[i];
    for (std::size_t j = 0; j < rows.size(); ++j) {
      if (j != i && rows[j][column] != 0) rows[j] = combination(rows[i][column], rows[j], -rows[j][column], rows[i]);
    }
  }
}

// The same ray modulo the lines, with zeros where the lines have their first entries.
IntegerVector reduced(IntegerVector ray, std::span<const IntegerVector> lines) {
  for (const IntegerVector& line : lines) {
    const std::size_t column = first_nonzero(line);
    if (ray[column] != 0) ray = combination(line[column], ray, -ray[column], line);
  }
  return primitive(ray);
}

}  // namespace

bool Cone::clip_rays(const HalfSpace& half_space) {
  const IntegerVector& c = half_space.normal();
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (sign_of_dot(c, lines_[i]) == 0) continue;
    clip_line(half_space, i);
    return true;
  }
  std::vector<Int128> products;
  std::vector<int> sides;
  products.reserve(rays_.size());
  sides.reserve(rays_.size());
  for (const IntegerVector& ray : rays_) {
    products.push_back(dot(c, ray));
    sides.push_back(sign(products.back()));
  }
  if (std::none_of(sides.begin(), sides.end(), [](int s) { return s < 0; })) return true;
  if (std::none_of(sides.begin(), sides.end(), [](int s) { return s > 0; })) return false;
  cut_rays(half_space, sides, products);
  return true;
}

// The line becomes a ray, the others move along it onto the boundary.
void Cone::clip_line(const HalfSpace& half_space, std::size_t line) {
  const IntegerVector& c = half_space.normal();
  const IntegerVector out = sign_of_dot(c, lines_[line]) > 0 ? lines_[line] : -lines_[line];
  const Int128 height = dot(c, out);
  std::vector<IntegerVector> lines;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (i != line) lines.push_back(combination(height, lines_[i], -dot(c, lines_[i]), out));
  }
  reduce_rows(lines);
  std::vector<IntegerVector> rays;
  for (const IntegerVector& ray : rays_) rays.push_back(reduced(combination(height, ray, -dot(c, ray), out), lines));
  rays.push_back(reduced(out, lines));

  const FacetSets old{std::move(tight_), facets_.size()};
  FacetSets tight{facets_.size() + 1};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Word* set = tight.add();
    for (std::size_t k = 0; k < facets_.size(); ++k) {
      if (i == rays_.size() || has_bit(old[i], k)) set_bit(set, k);
    }
    if (i < rays_.size()) set_bit(set, facets_.size());
  }
  facets_.push_back(half_space);
  lines_ = std::move(lines);
  rays_ = std::move(rays);
  tight_ = tight.take();
}

void Cone::cut_rays(const HalfSpace& half_space, std::span<const int> sides, std::span<const Int128> products) {
  const FacetSets old{tight_, facets_.size()};
  const std::size_t rank = dimension_ - lines_.size();
  std::vector<IntegerVector> rays;
  rays.reserve(2 * rays_.size());
  FacetSets tight{facets_.size() + 1};
  const auto add = [&](const IntegerVector& ray, const Word* set, const Word* other, bool on_boundary) {
    rays.push_back(ray);
    Word* facets = tight.add();
    for (std::size_t k = 0; k < old.words(); ++k) facets[k] = set[k] & other[k];
    if (on_boundary) set_bit(facets, facets_.size());
  };

  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (sides[i] >= 0) add(rays_[i], old[i], old[i], sides[i] == 0);
  }
  const auto meet = [&](std::size_t i, std::size_t j) {
    return old.words() == 1 ? are_adjacent(tight_, i, j, rank) : are_adjacent(old, rays_.size(), i, j, rank);
  };
  std::vector<std::size_t> beyond;
  for (std::size_t j = 0; j < rays_.size(); ++j) {
    if (sides[j] < 0) beyond.push_back(j);
  }
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (sides[i] <= 0) continue;
    for (const std::size_t j : beyond) {
      if (meet(i, j)) add(combination(products[i], rays_[j], -products[j], rays_[i]), old[i], old[j], true);
    }
  }

  const auto left = facets_left(tight, rays.size(), facets_.size() + 1);
  std::vector<HalfSpace> facets;
  facets.reserve(left.size());
  for (const std::size_t k : left) facets.push_back(k < facets_.size() ? facets_[k] : half_space);
  tight_ = left.size() == facets_.size() + 1 ? tight.take() : only(tight, rays.size(), left).take();
  facets_ = std::move(facets);
  rays_ = std::move(rays);
}

}  // namespace kith
