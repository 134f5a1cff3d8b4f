// Cones in three dimensions by clipping; in others see cone_rays.cpp. A polygon keeps, beside its facets f_0, ...,
// f_(n-1), the extreme rays r_i = f_i x f_(i+1) (cyclic), so that facet i spans the arc from r_(i-1) to r_i. A new
// half-space c is compared with the rays only: the exact signs of c . r_i tell which facets survive.

#include "kith/geometry/cone.hpp"

#include <array>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "exact.hpp"

namespace kith {
namespace {

constexpr std::size_t kUsualFacets = 8;  // more than nearly every cone has, so that growing does not allocate again

using detail::cross_of_normals;
using detail::cross_unchecked;
using detail::first_nonzero;
using detail::side;

IntegerVector axis(std::size_t k) {
  IntegerVector e(3);
  e[k] = 1;
  return e;
}

// A lune's edge is the line along +-edge. rays[i] lies inside facet i alone, so
// that the lune is the line plus the combinations of the two. The cross product
// with an axis, rather than with the edge, keeps the entries small.
struct LuneFrame {
  IntegerVector edge;
  std::array<IntegerVector, 2> rays;
};

LuneFrame lune_frame(const HalfSpace& first, const HalfSpace& second) {
  const IntegerVector edge = cross_of_normals(first, second);
  const std::size_t k = first_nonzero(edge);
  const IntegerVector e = edge[k] > 0 ? axis(k) : -axis(k);
  return {edge, {cross_unchecked(e, first.normal()), cross_unchecked(second.normal(), e)}};
}

using Wide = std::array<Int128, IntegerVector::kMaxDimension>;

// Divides by the gcd in 128 bits; only then must the entries fit into 64.
IntegerVector narrowed(const Wide& v, std::size_t dimension) {
  Int128 divisor = 0;
  for (Int128 x : v) {
    x = x < 0 ? -x : x;
    while (x != 0) divisor = std::exchange(x, divisor % x);
  }
  KITH_ASSERT(divisor != 0);  // the extreme rays of a pointed cone lie on one side of a plane
  IntegerVector result(dimension);
  for (std::size_t k = 0; k < dimension; ++k) {
    const Int128 x = v[k] / divisor;
    if (x < std::numeric_limits<std::int64_t>::min() || x > std::numeric_limits<std::int64_t>::max()) {
      throw std::overflow_error{"Cone::interior_direction: an entry leaves 64 bits"};
    }
    result[k] = static_cast<std::int64_t>(x);
  }
  return result;
}

}  // namespace

Cone::Cone(std::size_t dimension) : dimension_{dimension} {
  if (dimension < 2 || dimension > IntegerVector::kMaxDimension) {
    throw std::invalid_argument{"Cone: the dimension must be 2 to 8, not " + std::to_string(dimension)};
  }
  if (dimension == 3) return;
  for (std::size_t k = 0; k < dimension; ++k) {
    lines_.emplace_back(dimension);
    lines_.back()[k] = 1;
  }
}

std::optional<Cone> Cone::intersection(std::span<const HalfSpace> half_spaces) {
  Cone cone{half_spaces.empty() ? 3 : half_spaces.front().dimension()};
  const std::size_t expected = std::min<std::size_t>(half_spaces.size() + 1, kUsualFacets);
  cone.facets_.reserve(expected);
  cone.rays_.reserve(expected);
  if (!cone.clip(half_spaces)) return std::nullopt;
  return cone;
}

bool Cone::clip(std::span<const HalfSpace> half_spaces) {
  for (const HalfSpace& half_space : half_spaces) {
    if (!clip(half_space)) return false;
  }
  return true;
}

std::optional<Cone> Cone::clipped(const HalfSpace& half_space) const {
  Cone cone = *this;
  if (!cone.clip(half_space)) return std::nullopt;
  return cone;
}

bool Cone::clip_beyond_space(const HalfSpace& half_space) {
  if (half_space.dimension() != dimension_) {
    throw std::invalid_argument{"Cone: a half-space in " + std::to_string(half_space.dimension()) +
                                " dimensions cannot clip a cone in " + std::to_string(dimension_)};
  }
  return clip_rays(half_space);
}

bool Cone::clip(const HalfSpace& half_space) {
  if (dimension_ != 3 || half_space.dimension() != 3) [[unlikely]] {
    return clip_beyond_space(half_space);
  }
  switch (facets_.size()) {
    case 0:
      facets_.push_back(half_space);
      return true;
    case 1:
      if (facets_.front() == half_space) return true;
      if (facets_.front().normal() == -half_space.normal()) return false;
      facets_.push_back(half_space);
      return true;
    case 2:
      return clip_lune(half_space);
    default:
      return clip_polygon(half_space);
  }
}

bool Cone::clip_lune(const HalfSpace& half_space) {
  const auto [edge, rays] = lune_frame(facets_[0], facets_[1]);
  const int along_edge = side(half_space, edge);
  if (along_edge != 0) {
    to_triangle(half_space, along_edge);
    return true;
  }
  // All three normals lie in one plane, where the lune is the wedge between its two rays.
  const int first = side(half_space, rays[0]);
  const int second = side(half_space, rays[1]);
  if (first >= 0 && second >= 0) return true;
  if (first <= 0 && second <= 0) return false;
  facets_[first > 0 ? 1 : 0] = half_space;
  return true;
}

void Cone::to_triangle(const HalfSpace& half_space, int orientation) {
  if (orientation < 0) std::swap(facets_[0], facets_[1]);
  facets_.push_back(half_space);
  for (std::size_t i = 0; i < 3; ++i) rays_.push_back(cross_of_normals(facets_[i], facets_[(i + 1) % 3]));
}

// The rays strictly inside are consecutive (convexity), hence so are the others.
bool Cone::clip_polygon(const HalfSpace& half_space) {
  const std::size_t n = rays_.size();
  const auto first = [n](std::size_t from, auto claim) {
    while (from < n && !claim(from)) ++from;
    return from;
  };
  const auto inside = [&](std::size_t i) { return side(half_space, rays_[i]) > 0; };
  const auto not_inside = [&](std::size_t i) { return side(half_space, rays_[i]) <= 0; };

  const std::size_t beyond = first(0, [&](std::size_t i) { return side(half_space, rays_[i]) < 0; });
  if (beyond == n) return true;
  if (inside(0)) {
    replace_rays(half_space, first(1, not_inside), first(beyond, inside));
    return true;
  }
  const std::size_t begin = first(1, inside);
  if (begin == n) return false;
  const std::size_t end = first(begin, not_inside);
  if (end == n) {
    replace_rays(half_space, 0, begin);
    return true;
  }
  const auto head = static_cast<std::ptrdiff_t>(begin);
  facets_.erase(facets_.begin(), facets_.begin() + head);
  rays_.erase(rays_.begin(), rays_.begin() + head);
  replace_rays(half_space, end - begin, n - begin);
  return true;
}

// Replaces the rays begin .. end-1 by the two ends of the new facet, and the
// facets between them by the new one. Facets `begin` and `end` (cyclic) are cut.
void Cone::replace_rays(const HalfSpace& half_space, std::size_t begin, std::size_t end) {
  const IntegerVector entry = cross_of_normals(facets_[begin], half_space);
  const IntegerVector exit = cross_of_normals(half_space, facets_[end == facets_.size() ? 0 : end]);
  const auto from = static_cast<std::ptrdiff_t>(begin);
  const auto to = static_cast<std::ptrdiff_t>(end);
  rays_[begin] = entry;
  if (begin + 1 == end) {
    facets_.insert(facets_.begin() + to, half_space);
    rays_.insert(rays_.begin() + to, exit);
    return;
  }
  facets_[begin + 1] = half_space;
  facets_.erase(facets_.begin() + from + 2, facets_.begin() + to);
  rays_[begin + 1] = exit;
  rays_.erase(rays_.begin() + from + 2, rays_.begin() + to);
}

bool Cone::implies(const HalfSpace& half_space) const {
  const auto holds = [&](const IntegerVector& ray) { return sign_of_dot(half_space.normal(), ray) >= 0; };
  const auto is_flat = [&](const IntegerVector& line) { return sign_of_dot(half_space.normal(), line) == 0; };
  if (dimension_ != 3) {
    return std::all_of(lines_.begin(), lines_.end(), is_flat) && std::all_of(rays_.begin(), rays_.end(), holds);
  }
  if (facets_.empty()) return false;
  if (facets_.size() == 1) return facets_.front() == half_space;
  if (facets_.size() == 2) {
    const auto [edge, rays] = lune_frame(facets_[0], facets_[1]);
    return side(half_space, edge) == 0 && side(half_space, rays[0]) >= 0 && side(half_space, rays[1]) >= 0;
  }
  return std::all_of(rays_.begin(), rays_.end(), [&](const IntegerVector& ray) { return side(half_space, ray) >= 0; });
}

bool Cone::is_cut_by(const HalfSpace& half_space) const {
  return !implies(half_space) && !implies(half_space.opposite());
}

std::vector<HalfSpace> Cone::minimal_set() const {
  std::vector<HalfSpace> sorted = facets_;
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

std::vector<IntegerVector> Cone::generators() const {
  if (dimension_ == 3) return generators_in_space();
  std::vector<IntegerVector> result = rays_;
  std::sort(result.begin(), result.end());
  for (const IntegerVector& line : lines_) {
    result.push_back(line);
    result.push_back(-line);
  }
  return result;
}

std::vector<IntegerVector> Cone::generators_in_space() const {
  std::vector<IntegerVector> result;
  for (const IntegerVector& ray : rays_) result.push_back(primitive(ray));
  const auto add_line = [&](const IntegerVector& v) {
    result.push_back(v);
    result.push_back(-v);
  };
  if (facets_.empty()) {
    for (std::size_t k = 0; k < 3; ++k) add_line(axis(k));
  } else if (facets_.size() == 1) {
    const IntegerVector& normal = facets_.front().normal();
    const std::size_t k = first_nonzero(normal);
    result.push_back(normal);
    for (std::size_t j = 0; j < 3; ++j) {
      if (j != k) add_line(primitive(cross_unchecked(axis(j), normal)));
    }
  } else if (facets_.size() == 2) {
    const auto [edge, rays] = lune_frame(facets_[0], facets_[1]);
    result.assign({primitive(rays[0]), primitive(rays[1])});
    add_line(primitive(edge));
  }
  return result;
}

IntegerVector Cone::interior_direction() const {
  if (dimension_ == 3) return interior_direction_in_space();
  if (rays_.empty()) return lines_.back();
  Wide sum{};
  for (const IntegerVector& ray : rays_)
    for (std::size_t k = 0; k < dimension_; ++k) sum[k] += ray[k];
  return narrowed(sum, dimension_);
}

IntegerVector Cone::interior_direction_in_space() const {
  if (facets_.empty()) return axis(2);
  if (facets_.size() == 1) return facets_.front().normal();
  if (facets_.size() == 2) {
    const LuneFrame frame = lune_frame(facets_[0], facets_[1]);
    return primitive(frame.rays[0] + frame.rays[1]);
  }
  Wide sum{};
  for (const IntegerVector& ray : rays_) {
    const IntegerVector shortest = primitive(ray);
    for (std::size_t k = 0; k < 3; ++k) sum[k] += shortest[k];
  }
  return narrowed(sum, 3);
}

bool Cone::contains(const Eigen::Vector3d& w) const noexcept {
  return std::all_of(facets_.begin(), facets_.end(), [&](const HalfSpace& facet) { return facet.contains(w); });
}

bool Cone::contains(const IntegerVector& w) const {
  return std::all_of(facets_.begin(), facets_.end(), [&](const HalfSpace& facet) { return facet.contains(w); });
}

bool operator==(const Cone& a, const Cone& b) {
  if (a.dimension_ != b.dimension_ || a.facets_.size() != b.facets_.size()) return false;
  return std::is_permutation(a.facets_.begin(), a.facets_.end(), b.facets_.begin());
}

}  // namespace kith
