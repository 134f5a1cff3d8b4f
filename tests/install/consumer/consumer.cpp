#include <cmath>
#include <cstdio>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/geometry/cloud.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/geometry/cone_sampler.hpp"
#include "kith/geometry/cover.hpp"

// Prints numbers that the libraries compute, exactly. All programs that link the same libraries must print the same,
// whatever instruction set they are compiled for: what is made here is used and freed there, and the other way round.
namespace {

template <typename Vector>
void print(const char* what, const Vector& vector) {
  std::printf("%s:", what);
  for (const double entry : vector) std::printf(" %a", entry);
  std::printf("\n");
}

void print_beliefs(const kith::Cone& region) {
  const kith::PriorCover cover{region, 200};
  std::vector<kith::Direction> normals = cover.normals();  // a copy: made here, of objects made there
  normals.emplace_back(kith::Direction::Unit(3, 0));
  for (const auto& normal : normals) print("normal", normal);
  kith::ParticleBelief belief{cover, {.particles = 200}};
  const std::vector<kith::HalfSpace> shown{kith::HalfSpace{{-2, 1, 4}}};
  belief.observe(shown, kith::HalfSpaceLikelihood{0.8}, kith::RandomStream{7});
  print("mean", belief.mean_direction());
}

void print_matrices(const kith::Cone& region) {
  Eigen::MatrixXd points = kith::cover(region, 50);  // allocated there
  points.conservativeResize(3, 60);                  // and again here
  points.rightCols(10).setOnes();
  const Eigen::MatrixXd covering = points.leftCols(50);
  const auto centres = kith::k_centres(covering, 3, 0);
  for (const auto centre : centres) print("centre", points.col(static_cast<Eigen::Index>(centre)));
  const kith::Cloud cloud{kith::ConeSampler{region}, 100};
  Eigen::MatrixXd copy = cloud.points();
  kith::Cloud moved{cloud};
  moved = kith::Cloud{kith::ConeSampler{region}, 10};
  print("point", copy.col(99));
  print("point", moved.points().col(9));
}

}  // namespace

int main() {
  const auto region = kith::Cone::intersection(
      std::vector{kith::HalfSpace{{-1, 0, 2}}, kith::HalfSpace{{0, -1, -4}}, kith::HalfSpace{{1, 1, 0}}});
  const kith::Domain domain = kith::load_domain("item-delivery");  // a built-in domain comes along in the library
  std::printf("Direction: %zu bytes, aligned to %zu\n", sizeof(kith::Direction), alignof(kith::Direction));
  std::printf("area: %a, starts: %zu\n", region->solid_angle(), domain.num_starts());
  print("weights", domain.weights().unit);
  print_beliefs(*region);
  print_matrices(*region);
  const bool right = std::abs(region->solid_angle() - 0.0260947) < 1e-7 && domain.num_starts() == 9312;
  return right ? 0 : 1;
}
