#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "evaluation.hpp"
#include "kith/study_design/response_surface.hpp"
#include "parameter_box.hpp"

namespace kith {

// One quadratic per target over a box. Figures that have to be met within a factor are fitted on the log scale. Misses
// are in published standard errors.
class Surfaces {
 public:
  // @param points  unit coordinates. @pre as many evaluations, at least three.
  Surfaces(std::span<const Target> targets, Box box, std::span<const std::vector<double>> points,
           std::span<const Evaluation> evaluations);

  // From now on every figure is higher by what a more exact simulation at this point says.
  void correct(std::span<const double> unit, const Evaluation& exact);

  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] const ResponseSurface& surface(std::size_t target) const { return surfaces_[target]; }
  [[nodiscard]] std::vector<double> misses_at(std::span<const double> unit) const;
  // Covariance of the misses by chance, shape [targets, targets]: of the published figures (correlated as those of
  // simulated teams are), of the simulation at the point of correct(), and of the surfaces.
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }
  // The surface's error in the figure's own unit; of a logarithmic one, at the target's value.
  [[nodiscard]] double error_of(std::size_t target) const;

 private:
  void set_covariance(const Eigen::MatrixXd& simulation);
  // Standard error of the prediction of a target's miss.
  [[nodiscard]] double miss_error(std::size_t target) const;

  std::span<const Target> targets_;
  Box box_;
  std::size_t num_points_ = 0;
  std::vector<ResponseSurface> surfaces_;
  std::vector<double> offsets_;  // on the scale of the surfaces
  Eigen::MatrixXd correlation_;  // of the targets' figures
  Eigen::MatrixXd covariance_;
};

}  // namespace kith
