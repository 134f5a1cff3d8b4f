#include "slice_moves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "kith/core/assert.hpp"
#include "kith/core/batch_normal.hpp"
#include "kith/core/eighth_turn.hpp"
#include "kith/core/integer_vector.hpp"
#include "kith/core/vector_clones.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kMost = IntegerVector::kMaxDimension;
constexpr std::size_t kMostShrinkages = 100;
constexpr float kOutside = -std::numeric_limits<float>::infinity();
constexpr double kShortest = 1e-12;  // square of the length of a tangent that has a direction
// Margins from the prior's boundary that single precision cannot tell from 0.
constexpr float kUnsure = 4e-6f;

// Points that are moved side by side. Angles and densities are in single precision, which decides between moves that
// are equally good; the points stay in double precision (decision 15).
constexpr std::size_t kLanes = 32;
constexpr std::size_t kBlock = NormalPairs::kBlock;  // points that share blocks of random numbers
using Floats = std::array<float, kLanes>;
using Doubles = std::array<double, kLanes>;
template <typename Values>
using Axes = std::array<Values, kMost>;

// Half-spaces in single precision, and where great circles lie in them: x(angle) = point cos(angle) + side sin(angle).
struct Falls {
  std::vector<float> normals;       // row-major, shape [n, d]
  std::vector<float> far, slope;    // shape [n]; empty for a prior
  std::vector<Floats> point, side;  // u . point and u . side, shape [n, kLanes]

  explicit Falls(std::span<const double> unit_normals, std::size_t d)
      : normals(unit_normals.begin(), unit_normals.end()), point(normals.size() / d), side(normals.size() / d) {}
  [[nodiscard]] std::size_t size() const noexcept { return point.size(); }
};

struct Lanes {
  Axes<Doubles> point, side;
  Axes<Floats> rough_point, rough_side;
  Floats cosine, sine;              // of the angle that is tried
  Floats found_cosine, found_sine;  // of the angle that is taken
  Floats low, high, angle;          // one turn is 1
  Floats density, level, margin;
  std::array<std::int32_t, kLanes> is_open;
};

// Uniform unit vectors at right angles to the points from normals, `stride` of each axis.
KITH_VECTOR_CLONES void aim(const float* normals, std::size_t stride, std::size_t d, Lanes& lanes) {
  Doubles along{};
  for (std::size_t k = 0; k < d; ++k) {
    const float* const normal = normals + k * stride;
    const double* const point = lanes.point[k].data();
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < kLanes; ++i) along[i] += static_cast<double>(normal[i]) * point[i];
  }

  Doubles square{};
  for (std::size_t k = 0; k < d; ++k) {
    const float* const normal = normals + k * stride;
    const double* const point = lanes.point[k].data();
    double* const side = lanes.side[k].data();
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < kLanes; ++i) {
      side[i] = static_cast<double>(normal[i]) - along[i] * point[i];
      square[i] += side[i] * side[i];
    }
  }

  Doubles scale;
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double inverse = 1.0 / std::sqrt(square[i]);
    scale[i] = square[i] > kShortest ? inverse : 0.0;
    lanes.is_open[i] = square[i] > kShortest ? 1 : 0;
  }

  for (std::size_t k = 0; k < d; ++k) {
    const double* const point = lanes.point[k].data();
    double* const side = lanes.side[k].data();
    float* const rough_point = lanes.rough_point[k].data();
    float* const rough_side = lanes.rough_side[k].data();
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < kLanes; ++i) {
      side[i] *= scale[i];
      rough_point[i] = static_cast<float>(point[i]);
      rough_side[i] = static_cast<float>(side[i]);
    }
  }
}

template <std::size_t d>
[[gnu::always_inline]] inline void lay_in(Falls& falls, const Lanes& lanes) {
  for (std::size_t j = 0; j < falls.size(); ++j) {
    const float* const u = falls.normals.data() + j * d;
    float* const point = falls.point[j].data();
    float* const side = falls.side[j].data();
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < kLanes; ++i) {
      float p = 0.0f;
      float s = 0.0f;
      for (std::size_t k = 0; k < d; ++k) {
        p += u[k] * lanes.rough_point[k][i];
        s += u[k] * lanes.rough_side[k][i];
      }
      point[i] = p;
      side[i] = s;
    }
  }
}

KITH_VECTOR_CLONES void lay(Falls& falls, std::size_t d, const Lanes& lanes) {
  switch (d) {
    case 2:
      return lay_in<2>(falls, lanes);
    case 3:
      return lay_in<3>(falls, lanes);
    case 4:
      return lay_in<4>(falls, lanes);
    case 5:
      return lay_in<5>(falls, lanes);
    case 6:
      return lay_in<6>(falls, lanes);
    case 7:
      return lay_in<7>(falls, lanes);
    default:
      return lay_in<8>(falls, lanes);
  }
}

// The log densities at the angles, and the smallest margins over the prior's normals.
KITH_VECTOR_CLONES void weigh(const Falls& prior, const Falls& falls, Lanes& lanes) {
  Floats sum{};
  Floats least;
  least.fill(1.0f);
  const Floats* points = prior.point.data();  // unchecked, for speed
  const Floats* sides = prior.side.data();
  for (std::size_t j = 0; j < prior.size(); ++j) {
    const float* const point = points[j].data();
    const float* const side = sides[j].data();
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < kLanes; ++i) {
      const float t = point[i] * lanes.cosine[i] + side[i] * lanes.sine[i];
      least[i] = t < least[i] ? t : least[i];
    }
  }

  points = falls.point.data();
  sides = falls.side.data();
  const float* const fars = falls.far.data();
  const float* const slopes = falls.slope.data();
  for (std::size_t j = 0; j < falls.size(); ++j) {
    const float* const point = points[j].data();
    const float* const side = sides[j].data();
    const float far = fars[j];
    const float slope = slopes[j];
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < kLanes; ++i) {
      const float t = point[i] * lanes.cosine[i] + side[i] * lanes.sine[i];
      const float fall = far + slope * t;
      sum[i] += t < 0.0f ? fall : 0.0f;
    }
  }
  lanes.density = sum;
  lanes.margin = least;
}

// Levels below the densities of the points, by exponential deviates from the radii of pairs of normals. What lies
// outside the prior stays.
KITH_VECTOR_CLONES void set_levels(const float* first, const float* second, Lanes& lanes) {
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) {
    const float level = lanes.density[i] - 0.5f * (first[i] * first[i] + second[i] * second[i]);
    const std::int32_t may_move = level > kOutside && lanes.margin[i] > -kUnsure ? 1 : 0;
    lanes.level[i] = level;
    lanes.is_open[i] &= may_move;
    lanes.found_cosine[i] = 1.0f;
    lanes.found_sine[i] = 0.0f;
  }
}

// cos and sin of angles in (-1, 1] turns: of an angle a in [-pi/4, pi/4] about the nearest axis.
KITH_VECTOR_CLONES void turn(Lanes& lanes) {
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) {
    const float quarters = 4.0f * lanes.angle[i];
    const float half = quarters < 0.0f ? -0.5f : 0.5f;
    const auto axis = static_cast<std::int32_t>(quarters + half);
    const float a = (quarters - static_cast<float>(axis)) * (0.5f * std::numbers::pi_v<float>);
    const auto [s, c] = sine_cosine_in_eighth_turn(a);
    const float x = (axis & 1) != 0 ? s : c;
    const float y = (axis & 1) != 0 ? c : s;
    lanes.cosine[i] = ((axis + 1) & 2) != 0 ? -x : x;
    lanes.sine[i] = (axis & 2) != 0 ? -y : y;
  }
}

// A number in [0, 1) from its upper 24 bits.
[[gnu::always_inline]] inline float uniform_of(std::uint32_t word) {
  return static_cast<float>(static_cast<std::int32_t>(word >> 8u)) * 0x1.0p-24f;
}

KITH_VECTOR_CLONES void first_angles(const std::uint32_t* words, Lanes& lanes) {
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) {
    const float u = uniform_of(words[i]);
    lanes.angle[i] = u;
    lanes.high[i] = u;
    lanes.low[i] = u - 1.0f;
  }
}

// Angles between the last ones, which are too far, and the points.
KITH_VECTOR_CLONES void shrink(const std::uint32_t* words, Lanes& lanes) {
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) {
    const float at = lanes.angle[i];
    const float low = at < 0.0f ? at : lanes.low[i];
    const float high = at < 0.0f ? lanes.high[i] : at;
    lanes.low[i] = low;
    lanes.high[i] = high;
    lanes.angle[i] = low + (high - low) * uniform_of(words[i]);
  }
}

// Takes the angles whose densities lie above the levels. @returns how many points still look for one.
KITH_VECTOR_CLONES std::int32_t take(Lanes& lanes) {
  std::int32_t num_open = 0;
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) {
    const std::int32_t is_high = lanes.density[i] > lanes.level[i] ? 1 : 0;
    const std::int32_t is_inside = lanes.margin[i] >= kUnsure ? 1 : 0;
    const std::int32_t is_found = lanes.is_open[i] & is_high & is_inside;
    const float c = is_found != 0 ? lanes.cosine[i] : lanes.found_cosine[i];
    const float s = is_found != 0 ? lanes.sine[i] : lanes.found_sine[i];
    const std::int32_t is_open = lanes.is_open[i] & (is_found ^ 1);
    lanes.found_cosine[i] = c;
    lanes.found_sine[i] = s;
    lanes.is_open[i] = is_open;
    num_open += is_open;
  }
  return num_open;
}

KITH_VECTOR_CLONES void arrive(std::size_t d, Lanes& lanes) {
  Doubles square{};
  for (std::size_t k = 0; k < d; ++k) {
    double* const point = lanes.point[k].data();
    const double* const side = lanes.side[k].data();
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < kLanes; ++i) {
      point[i] =
          point[i] * static_cast<double>(lanes.found_cosine[i]) + side[i] * static_cast<double>(lanes.found_sine[i]);
      square[i] += point[i] * point[i];
    }
  }
  Doubles length;
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) length[i] = std::sqrt(square[i]);
  for (std::size_t k = 0; k < d; ++k) {
    double* const point = lanes.point[k].data();
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < kLanes; ++i) point[i] /= length[i];
  }
}

// The random words of the angles that are tried, made when they are needed: few points need many.
class AngleWords {
 public:
  explicit AngleWords(RandomStream& random) : words_{random} {}

  void restart(std::uint64_t visit) {
    visit_ = visit;
    num_made_ = 0;
  }

  // One for each point of the block.
  [[nodiscard]] const std::uint32_t* of_attempt(std::size_t attempt) {
    while (num_made_ <= attempt) {
      if (blocks_.size() < num_made_ + 2) blocks_.resize(num_made_ + 2);
      words_.fill(visit_ * (kMostShrinkages / 2 + 1) + num_made_ / 2, blocks_[num_made_], blocks_[num_made_ + 1]);
      num_made_ += 2;
    }
    return blocks_[attempt].data();
  }

 private:
  WordPairs words_;
  std::uint64_t visit_ = 0;
  std::size_t num_made_ = 0;
  std::vector<WordPairs::Block> blocks_;
};

}  // namespace

void move_in_density(const FallingDensity& density, std::size_t sweeps, std::span<double> values,
                     RandomStream& random) {
  const std::size_t d = density.dimension;
  KITH_ASSERT(d >= 2 && d <= kMost);
  const std::size_t n = values.size() / d;
  Falls prior{density.prior, d};
  Falls falls{density.normals, d};
  falls.far.assign(density.far.begin(), density.far.end());
  falls.slope.assign(density.slope.begin(), density.slope.end());
  const NormalPairs pairs{random};
  AngleWords words{random};
  // As many as the tangents need, and one for the levels.
  const std::size_t num_pairs = (d + 1) / 2 + 1;
  std::array<NormalPairs::Block, kMost + 2> normals;
  Lanes lanes;
  for (std::size_t block = 0; block * kBlock < n; ++block) {
    for (std::size_t sweep = 0; sweep < sweeps; ++sweep) {
      const std::uint64_t visit = block * sweeps + sweep;
      words.restart(visit);
      for (std::size_t p = 0; p < num_pairs; ++p) {
        pairs.fill(visit * num_pairs + p, normals[2 * p], normals[2 * p + 1]);
      }
      for (std::size_t begin = 0; begin < kBlock && block * kBlock + begin < n; begin += kLanes) {
        const std::size_t first = block * kBlock + begin;
        const std::size_t count = std::min(kLanes, n - first);
        for (std::size_t k = 0; k < d; ++k) {
          const double* const from = values.data() + k * n + first;
          std::copy_n(from, count, lanes.point[k].begin());
          std::fill(lanes.point[k].begin() + static_cast<std::ptrdiff_t>(count), lanes.point[k].end(), from[0]);
        }
        aim(normals[0].data() + begin, kBlock, d, lanes);
        lay(prior, d, lanes);
        lay(falls, d, lanes);
        lanes.cosine.fill(1.0f);
        lanes.sine.fill(0.0f);
        weigh(prior, falls, lanes);
        set_levels(normals[2 * num_pairs - 2].data() + begin, normals[2 * num_pairs - 1].data() + begin, lanes);
        std::fill(lanes.is_open.begin() + static_cast<std::ptrdiff_t>(count), lanes.is_open.end(), 0);
        first_angles(words.of_attempt(0) + begin, lanes);
        for (std::size_t attempt = 1; attempt <= kMostShrinkages; ++attempt) {
          turn(lanes);
          weigh(prior, falls, lanes);
          if (take(lanes) == 0) break;
          shrink(words.of_attempt(attempt) + begin, lanes);
        }
        arrive(d, lanes);
        for (std::size_t k = 0; k < d; ++k) {
          std::copy_n(lanes.point[k].begin(), count, values.data() + k * n + first);
        }
      }
    }
  }
}

}  // namespace kith::detail
