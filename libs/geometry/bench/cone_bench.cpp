#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "../tests/random_systems.hpp"
#include "kith/geometry/cloud.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/geometry/cover.hpp"

namespace kith {
namespace {

std::vector<HalfSpace> system_of(std::int64_t n) {
  RandomStream random{1};
  return testing::random_feasible_system(static_cast<std::size_t>(n), 40, random);
}

Cone item_delivery_region() {
  return Cone::intersection(std::vector{HalfSpace{{-1, 0, 2}}, HalfSpace{{0, -1, -4}}, HalfSpace{{1, 1, 0}}}).value();
}

// How long does it take to reduce the constraints of one lesson (5), of a
// session (20), of a domain (200) to their minimal set?
void BM_MinimalSet(benchmark::State& state) {
  const auto system = system_of(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(minimal_set(system));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(BM_MinimalSet)->Arg(5)->Arg(20)->Arg(200);

// The textbook baseline: a row goes if it is a non-negative combination of one,
// two or three of the others, by integer determinants; O(n^4).
bool combines(const std::vector<IntegerVector>& rows, std::size_t target) {
  const auto sign3 = [&](const IntegerVector& a, const IntegerVector& b, const IntegerVector& c) {
    return sign_of_dot(cross(a, b), c);
  };
  const IntegerVector& c = rows[target];
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = i + 1; j < rows.size(); ++j) {
      if (i == target || j == target) continue;
      for (std::size_t k = j + 1; k < rows.size(); ++k) {
        if (k == target) continue;
        const int whole = sign3(rows[i], rows[j], rows[k]);
        if (whole == 0) continue;
        if (whole * sign3(c, rows[j], rows[k]) >= 0 && whole * sign3(rows[i], c, rows[k]) >= 0 &&
            whole * sign3(rows[i], rows[j], c) >= 0) {
          return true;
        }
      }
    }
  }
  return false;
}

void BM_MinimalSetByCombinations(benchmark::State& state) {
  const auto system = system_of(state.range(0));
  for (auto _ : state) {
    std::vector<IntegerVector> rows;
    for (const HalfSpace& h : system) rows.push_back(h.normal());
    for (std::size_t i = 0; i < rows.size();) {
      if (combines(rows, i)) {
        rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
    benchmark::DoNotOptimize(rows);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(BM_MinimalSetByCombinations)->Arg(5)->Arg(20)->Arg(200);

// What does one more half-space cost where it is redundant, the usual case?
void BM_ClipByARedundantHalfSpace(benchmark::State& state) {
  Cone cone = item_delivery_region();
  const HalfSpace redundant{{0, 0, -1}};
  for (auto _ : state) benchmark::DoNotOptimize(cone.clip(redundant));
}
BENCHMARK(BM_ClipByARedundantHalfSpace);

// What does a lesson's information gain cost beyond the clipping?
void BM_SolidAngle(benchmark::State& state) {
  const Cone cone = Cone::intersection(system_of(state.range(0))).value();
  for (auto _ : state) benchmark::DoNotOptimize(cone.solid_angle());
  state.counters["facets"] = static_cast<double>(cone.facets().size());
}
BENCHMARK(BM_SolidAngle)->Arg(3)->Arg(5)->Arg(20);

// The baseline: the share of n uniform points of the sphere that are inside.
void BM_SolidAngleByCounting(benchmark::State& state) {
  const Cone cone = Cone::intersection(system_of(5)).value();
  const Eigen::Matrix3Xd points = fibonacci_cover(Cone{}, static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    std::int64_t inside = 0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) inside += cone.contains(Eigen::Vector3d{points.col(i)}) ? 1 : 0;
    benchmark::DoNotOptimize(inside);
  }
}
BENCHMARK(BM_SolidAngleByCounting)->Arg(10000);

// How fast can a belief be reset to a region of 0.2 % of the sphere?
void BM_Sample(benchmark::State& state) {
  const Cone cone = item_delivery_region();
  RandomStream random{2};
  for (auto _ : state) benchmark::DoNotOptimize(cone.sample(random));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_Sample);

// The baseline: draw from the sphere until a point is inside.
void BM_SampleByRejection(benchmark::State& state) {
  const Cone cone = item_delivery_region();
  RandomStream random{2};
  for (auto _ : state) {
    Eigen::Vector3d w;
    do {
      w = Cone{}.sample(random);
    } while (!cone.contains(w));
    benchmark::DoNotOptimize(w);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_SampleByRejection);

std::vector<HalfSpace> system_in(benchmark::State& state) {
  RandomStream random{7};
  return testing::random_feasible_system(static_cast<std::size_t>(state.range(1)), 40, random,
                                         static_cast<std::size_t>(state.range(0)));
}

// What do more features cost? Facets and rays beside the time, since it grows with them.
void BM_MinimalSetInDimensions(benchmark::State& state) {
  const auto system = system_in(state);
  for (auto _ : state) benchmark::DoNotOptimize(minimal_set(system));
  const Cone cone = Cone::intersection(system).value();
  state.counters["facets"] = static_cast<double>(cone.facets().size());
  state.counters["rays"] = static_cast<double>(cone.generators().size());
}
BENCHMARK(BM_MinimalSetInDimensions)->ArgsProduct({{2, 3, 4, 5, 6, 7, 8}, {10, 20}});

// And an area? Its relative standard error in percent beside the time.
void BM_SolidAngleInDimensions(benchmark::State& state) {
  const Cone cone = Cone::intersection(system_in(state)).value();
  SolidAngle area;
  for (auto _ : state) benchmark::DoNotOptimize(area = cone.measure());
  state.counters["error_percent"] = 100.0 * area.standard_error / area.value;
  state.counters["parts"] = static_cast<double>(ConeSampler{cone}.num_parts());
}
BENCHMARK(BM_SolidAngleInDimensions)->ArgsProduct({{3, 4, 5, 6, 7}, {10, 20}})->Unit(benchmark::kMicrosecond);

void BM_SampleInDimensions(benchmark::State& state) {
  const ConeSampler sampler{Cone::intersection(system_in(state)).value()};
  RandomStream random{2};
  for (auto _ : state) benchmark::DoNotOptimize(sampler.sample(random));
}
BENCHMARK(BM_SampleInDimensions)->ArgsProduct({{3, 4, 5, 7}, {20}});

// What does a candidate cost where 4096 points stand for the region: three half-spaces whose bits are known?
void BM_ShareOfACloud(benchmark::State& state) {
  const auto system = system_in(state);
  const Cloud cloud{ConeSampler{Cone{static_cast<std::size_t>(state.range(0))}}, 4096};
  const auto a = cloud.mask(system[0]);
  const auto b = cloud.mask(system[1]);
  const auto c = cloud.mask(system[2]);
  for (auto _ : state) benchmark::DoNotOptimize(cloud.share({&a, &b, &c}));
}
BENCHMARK(BM_ShareOfACloud)->Args({7, 3});

// And the bits of a half-space?
void BM_MaskOfACloud(benchmark::State& state) {
  const auto system = system_in(state);
  const Cloud cloud{ConeSampler{Cone{static_cast<std::size_t>(state.range(0))}}, 4096};
  for (auto _ : state) benchmark::DoNotOptimize(cloud.mask(system[0]));
}
BENCHMARK(BM_MaskOfACloud)->Args({4, 3})->Args({7, 3});

}  // namespace
}  // namespace kith
