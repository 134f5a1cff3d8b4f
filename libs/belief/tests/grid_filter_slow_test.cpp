// The particle filter against an exact filter on a fixed grid of the hemisphere.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/geometry/cover.hpp"
#include "script.hpp"

namespace kith {
namespace {

using kith::testing::lower_hemisphere;
using kith::testing::random_half_space;

constexpr std::size_t kCells = 20'000;
constexpr std::size_t kTable = 4096;

// A density on 20 000 cells of equal area, updated by Bayes' rule in linear space.
class Grid {
 public:
  Grid() : centres_{fibonacci_cover(lower_hemisphere(), kCells)}, mass_(kCells, 1.0 / kCells) {}

  void observe(const std::vector<HalfSpace>& list, const HalfSpaceLikelihood& likelihood) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kCells; ++i) {
      for (const HalfSpace& h : list) mass_[i] *= likelihood.density(h.margin(centre(i)));
      sum += mass_[i];
    }
    for (double& m : mass_) m /= sum;
  }

  [[nodiscard]] double mass_in(const std::vector<HalfSpace>& region) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < kCells; ++i) {
      bool inside = true;
      for (const HalfSpace& h : region) inside = inside && h.contains(centre(i));
      sum += inside ? mass_[i] : 0.0;
    }
    return sum;
  }

  [[nodiscard]] double spread() const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < kCells; ++i) mean += mass_[i] * centre(i);
    mean.normalize();
    double sum = 0.0;
    for (std::size_t i = 0; i < kCells; ++i)
      sum += mass_[i] * std::pow(std::acos(std::min(1.0, mean.dot(centre(i)))), 2);
    return std::sqrt(sum);
  }

  // Each cell's mass spread by the density of an exponential map of N(0, h^2 I) over the cells of the
  // prior, renormalised there, since moves that leave the prior are drawn again. Cut at 5 h.
  void convolve(double h) {
    const double reach = 1.0 - std::cos(5.0 * h);
    std::array<double, kTable + 2> kernel{};  // over 1 - cosine, in steps of reach / kTable
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const double angle = std::acos(1.0 - reach * static_cast<double>(k) / kTable);
      kernel[k] = std::exp(-0.5 * angle * angle / (h * h)) * (k > 0 ? angle / std::sin(angle) : 1.0);
    }
    std::vector<double> result(kCells, 0.0);
    std::vector<std::size_t> near;
    std::vector<double> density;
    Eigen::VectorXd cosine(kCells);
    for (std::size_t i = 0; i < kCells; ++i) {
      near.clear();
      density.clear();
      cosine.noalias() = centres_.transpose() * centre(i);
      double sum = 0.0;
      for (std::size_t j = 0; j < kCells; ++j) {
        const double versine = std::max(0.0, 1.0 - cosine[static_cast<Eigen::Index>(j)]);
        if (versine > reach) continue;
        const double place = versine / reach * kTable;
        const auto k = static_cast<std::size_t>(place);
        near.push_back(j);
        density.push_back(kernel[k] + (place - static_cast<double>(k)) * (kernel[k + 1] - kernel[k]));
        sum += density.back();
      }
      for (std::size_t k = 0; k < near.size(); ++k) result[near[k]] += mass_[i] * density[k] / sum;
    }
    mass_ = result;
  }

 private:
  [[nodiscard]] Eigen::Vector3d centre(std::size_t i) const { return centres_.col(static_cast<Eigen::Index>(i)); }

  Eigen::Matrix3Xd centres_;
  std::vector<double> mass_;
};

// Lunes, polygons and hemispheres of at least 1 % of the prior's hemisphere.
std::vector<std::vector<HalfSpace>> regions(std::size_t n) {
  RandomStream random{99};
  std::vector<std::vector<HalfSpace>> list;
  while (list.size() < n) {
    const auto region = kith::testing::random_list(1 + list.size() % 4, random, 3);
    auto inside = region;
    inside.emplace_back(IntegerVector{0, 0, -1});
    if (solid_angle(inside) >= 0.01 * 2.0 * std::numbers::pi) list.push_back(region);
  }
  return list;
}

// What a person could have been shown: half-spaces that hold a truth, now and then one that does not.
struct Update {
  std::vector<HalfSpace> half_spaces;
  HalfSpaceLikelihood likelihood;
};

std::vector<Update> random_script(std::size_t updates, RandomStream random) {
  const Eigen::Vector3d truth = lower_hemisphere().sample(random);
  std::vector<Update> script;
  for (std::size_t u = 0; u < updates; ++u) {
    Update update{{}, HalfSpaceLikelihood{0.6 + 0.3 * uniform01(random)}};
    for (std::size_t k = 0; k < 1 + uniform_index(3, random); ++k) {
      const HalfSpace h = random_half_space(random);
      update.half_spaces.push_back(h.contains(truth) == (uniform01(random) < 0.85) ? h : h.opposite());
    }
    script.push_back(update);
  }
  return script;
}

// Mean and standard error of independent differences.
class Differences {
 public:
  void add(double d) {
    sum_ += d;
    squares_ += d * d;
    n_ += 1.0;
  }
  [[nodiscard]] double in_standard_errors() const {
    const double mean = sum_ / n_;
    const double variance = (squares_ / n_ - mean * mean) * n_ / (n_ - 1.0);
    return mean / std::sqrt(variance / n_);
  }
  [[nodiscard]] double mean() const { return sum_ / n_; }

 private:
  double sum_ = 0.0;
  double squares_ = 0.0;
  double n_ = 0.0;
};

// Without noise the filter's only error is that of resampling, which is unbiased: over 200 scripts the
// mean difference of each region's mass, and of all together, is within 4 of its own standard errors
// (13 comparisons of |z| > 4: 8e-4).
TEST(GridFilterSlow, AgreesWithTheParticleFilterWithoutNoise) {
  const FilterOptions options{.particles = kCells, .process_noise = 0.0, .resample_below = 0.5};
  const PriorCover cover{lower_hemisphere(), kCells};
  const Grid start;
  const auto areas = regions(12);
  std::vector<Differences> by_region(areas.size());
  Differences together;
  std::size_t num_resamplings = 0;
  for (std::uint64_t replicate = 0; replicate < 200; ++replicate) {
    const RandomStream random = RandomStream{2024}.split(replicate);
    ParticleBelief belief{cover, options};
    Grid grid = start;
    std::uint64_t n = 0;
    for (const Update& update : random_script(8, random.split("script"))) {
      belief.observe(update.half_spaces, update.likelihood, random.split("filter").split(n++));
      grid.observe(update.half_spaces, update.likelihood);
    }
    num_resamplings += belief.num_resamplings();
    double sum = 0.0;
    for (std::size_t r = 0; r < areas.size(); ++r) {
      const double difference = belief.mass_in(areas[r]) - grid.mass_in(areas[r]);
      by_region[r].add(difference);
      sum += difference;
      EXPECT_LT(std::abs(difference), 0.03);
    }
    together.add(sum / static_cast<double>(areas.size()));
  }
  EXPECT_GT(num_resamplings, 300u);
  EXPECT_LT(std::abs(together.in_standard_errors()), 4.0);
  for (const Differences& region : by_region) EXPECT_LT(std::abs(region.in_standard_errors()), 4.0) << region.mean();
}

// With noise the grid is convolved with the same kernel after every update. 3 scripts of 3 updates, 70
// replicates each; 18 comparisons of |z| > 4 and 69 degrees of freedom: 3e-3. To the 4 standard errors
// comes the grid's own error at the jumps of the likelihood, at most 3e-4 for cells of 3e-4 sr.
TEST(GridFilterSlow, AgreesWithTheParticleFilterWithNoise) {
  const FilterOptions options{.particles = kCells, .process_noise = 0.6, .resample_below = 1.0};
  const PriorCover cover{lower_hemisphere(), kCells};
  const auto areas = regions(6);
  for (std::uint64_t s = 0; s < 3; ++s) {
    const auto script = random_script(3, RandomStream{77}.split(s));
    Grid grid;
    for (const Update& update : script) {
      grid.observe(update.half_spaces, update.likelihood);
      grid.convolve(options.process_noise * grid.spread() * std::pow(static_cast<double>(kCells), -1.0 / 6.0));
    }
    std::vector<double> expected;
    for (const auto& area : areas) expected.push_back(grid.mass_in(area));
    std::vector<Differences> by_region(areas.size());
    for (std::uint64_t replicate = 0; replicate < 70; ++replicate) {
      ParticleBelief belief{cover, options};
      std::uint64_t n = 0;
      for (const Update& update : script) {
        belief.observe(update.half_spaces, update.likelihood, RandomStream{5}.split(s).split(replicate).split(n++));
      }
      ASSERT_EQ(belief.num_resamplings(), script.size());
      for (std::size_t r = 0; r < areas.size(); ++r) by_region[r].add(belief.mass_in(areas[r]) - expected[r]);
    }
    for (const Differences& region : by_region) {
      const double standard_error = std::abs(region.mean() / region.in_standard_errors());
      EXPECT_LT(std::abs(region.mean()), 4.0 * standard_error + 3e-4);
    }
  }
}

}  // namespace
}  // namespace kith
