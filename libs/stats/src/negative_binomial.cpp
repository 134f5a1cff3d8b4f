// With u = alpha mu, n observations of sum S in a cell and N_y observations of count y in all,
//
//   log L = sum_cells [S log mu - S log(1 + u) - n mu log(1 + u) / u]
//           + sum_y N_y [sum_{j < y} log(1 + alpha j) - log y!],
//
// which holds down to alpha = 0 without the differences of log-gammas at theta = 1 / alpha that lose all digits there.
#include "negative_binomial.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "rising_product.hpp"

namespace kith::detail {
namespace {

constexpr int kMostSteps = 200;
// A Newton step that promises less than this of log-likelihood is the last one: the coefficients are then off by 1e-7
// of their standard errors, and by the square of that once it is taken.
constexpr double kSmallestGain = 1e-14;
// A step is halved until the log-likelihood falls by no more than this part of itself: what rounding may do.
constexpr double kRoundingOfLikelihood = 1e-13;
// Where the variance exceeds the mean by less than this part of it, theta is taken as infinite.
constexpr double kLeastExcess = 1e-10;

// X' v and X' diag(w) X.
Eigen::VectorXd weighted_columns(const CountDesign& design, const Eigen::VectorXd& values) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(design.size);
  for (std::size_t c = 0; c < design.columns.size(); ++c) {
    for (const auto column : design.columns[c]) sums[column] += values[static_cast<Eigen::Index>(c)];
  }
  return sums;
}
Eigen::MatrixXd weighted_products(const CountDesign& design, const Eigen::VectorXd& weights) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(design.size, design.size);
  for (std::size_t c = 0; c < design.columns.size(); ++c) {
    for (const auto row : design.columns[c]) {
      for (const auto column : design.columns[c]) products(row, column) += weights[static_cast<Eigen::Index>(c)];
    }
  }
  return products;
}

// What of the log-likelihood depends on the coefficients.
double cell_log_likelihood(const CountData& data, const Eigen::VectorXd& eta, double alpha) {
  double sum = 0.0;
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    const auto& cell = data.cells[c];
    const double eta_c = eta[static_cast<Eigen::Index>(c)];
    const double mu = std::exp(eta_c);
    const double u = alpha * mu;
    sum += cell.sum * (eta_c - std::log1p(u)) - cell.observations * mu * log1p_ratio(u);
  }
  return sum;
}

double log_likelihood(const CountData& data, const CountDesign& design, const Eigen::VectorXd& coefficients,
                      double alpha) {
  const RisingProduct rising{alpha};
  double sum = cell_log_likelihood(data, linear_predictor(design, coefficients), alpha) - data.log_factorials;
  for (const auto& [count, observations] : data.frequencies) sum += observations * rising.log(count);
  return sum;
}

// Weighted least squares on log(mean + 1/10): close enough for Newton, and finite in cells of zeros.
Eigen::VectorXd first_guess(const CountData& data, const CountDesign& design) {
  Eigen::VectorXd weights(static_cast<Eigen::Index>(data.cells.size()));
  Eigen::VectorXd values(weights.size());
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    const auto& cell = data.cells[c];
    const double mean = cell.sum / cell.observations + 0.1;
    weights[static_cast<Eigen::Index>(c)] = cell.observations * mean;
    values[static_cast<Eigen::Index>(c)] = cell.observations * mean * std::log(mean);
  }
  return weighted_products(design, weights).ldlt().solve(weighted_columns(design, values));
}

// The step to the maximum of the likelihood's quadratic approximation: with the observed information (Newton), or with
// the expected one (Fisher), which stays large where the data are far from what the coefficients say.
enum class Information { kObserved, kExpected };
struct ScoringStep {
  Eigen::VectorXd step;
  double gain = 0.0;  // of log-likelihood, twice what the approximation promises
};
ScoringStep scoring_step(const CountData& data, const CountDesign& design, const Eigen::VectorXd& eta, double alpha,
                         Information information) {
  Eigen::VectorXd scores(eta.size());
  Eigen::VectorXd weights(eta.size());
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    const auto& cell = data.cells[c];
    const auto row = static_cast<Eigen::Index>(c);
    const double mu = std::exp(eta[row]);
    const double spread = 1.0 + alpha * mu;
    scores[row] = (cell.sum - cell.observations * mu) / spread;
    weights[row] = information == Information::kObserved
                       ? (alpha * cell.sum + cell.observations) * mu / (spread * spread)
                       : cell.observations * mu / spread;
  }
  const Eigen::VectorXd gradient = weighted_columns(design, scores);
  const Eigen::VectorXd step = weighted_products(design, weights).ldlt().solve(gradient);
  return {step, step.dot(gradient)};
}

// Maximises the likelihood over the coefficients for given alpha. It is concave in them, so steps that are
// halved until they do not lose get there from anywhere, unless the maximum lies at infinity.
std::optional<Eigen::VectorXd> fit_coefficients(const CountData& data, const CountDesign& design, double alpha,
                                                Eigen::VectorXd coefficients) {
  Eigen::VectorXd eta = linear_predictor(design, coefficients);
  double likelihood = cell_log_likelihood(data, eta, alpha);
  // Moves by the step if that loses nothing but rounding.
  const auto accepts = [&](const Eigen::VectorXd& step) {
    const Eigen::VectorXd next = coefficients + step;
    const Eigen::VectorXd next_eta = linear_predictor(design, next);
    const double next_likelihood = cell_log_likelihood(data, next_eta, alpha);
    const double allowed_loss = kRoundingOfLikelihood * (1.0 + std::abs(likelihood));
    if (!(next_likelihood >= likelihood - allowed_loss)) return false;
    coefficients = next;
    eta = next_eta;
    likelihood = next_likelihood;
    return true;
  };
  for (int iteration = 0; iteration < kMostSteps; ++iteration) {
    const auto newton = scoring_step(data, design, eta, alpha, Information::kObserved);
    if (newton.step.allFinite()) {
      if (newton.gain <= kSmallestGain) return coefficients + newton.step;
      if (accepts(newton.step)) continue;
    }
    auto fisher = scoring_step(data, design, eta, alpha, Information::kExpected);
    if (!fisher.step.allFinite()) return std::nullopt;
    while (!accepts(fisher.step)) {
      fisher.step /= 2.0;
      fisher.gain /= 2.0;
      if (fisher.gain <= kSmallestGain) return coefficients;
    }
  }
  return std::nullopt;
}

// The derivative of the log-likelihood by alpha; at the best coefficients for this alpha that of the profile
// likelihood.
double alpha_score(const CountData& data, const CountDesign& design, const Eigen::VectorXd& coefficients,
                   double alpha) {
  const RisingProduct rising{alpha};
  const Eigen::VectorXd mu = linear_predictor(design, coefficients).array().exp();
  double score = 0.0;
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    const auto& cell = data.cells[c];
    const double mu_c = mu[static_cast<Eigen::Index>(c)];
    const double u = alpha * mu_c;
    score += cell.observations * mu_c * mu_c * (log1p_rest(u) + 1.0 / (1.0 + u)) - cell.sum * mu_c / (1.0 + u);
  }
  for (const auto& [count, observations] : data.frequencies) score += observations * rising.slope(count);
  return score;
}

// Sum of squared deviations from the expected counts, less what Poisson's variance explains: twice the score at 0.
double excess_variance(const CountData& data, const Eigen::VectorXd& mu) {
  double excess = 0.0;
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    const auto& cell = data.cells[c];
    const double off = cell.sum / cell.observations - mu[static_cast<Eigen::Index>(c)];
    excess += cell.squares + cell.observations * off * off - cell.sum;
  }
  return excess;
}

// The root of the profile score by alpha: a bracket around a first guess, then Alefeld, Potra and Shi's method in
// log(alpha). Coefficients are taken along, as those of a near alpha are a good start.
class ProfileScore {
 public:
  ProfileScore(const CountData& data, const CountDesign& design, Eigen::VectorXd start)
      : data_{data}, design_{design}, coefficients_{std::move(start)} {}

  double operator()(double log_alpha) {
    const double alpha = std::exp(log_alpha);
    const auto fitted = fit_coefficients(data_, design_, alpha, coefficients_);
    if (!fitted) {
      failed_ = true;
      return 0.0;  // ends the search
    }
    coefficients_ = *fitted;
    return alpha_score(data_, design_, coefficients_, alpha);
  }
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] const Eigen::VectorXd& coefficients() const { return coefficients_; }

 private:
  const CountData& data_;
  const CountDesign& design_;
  Eigen::VectorXd coefficients_;
  bool failed_ = false;
};

double find_root(ProfileScore& score, double guess, double least) {
  constexpr double kFactor = 1.4;  // of log(alpha), about four in alpha
  const auto sign = [](double value) { return value > 0.0 ? 1 : 0; };
  double low = guess;
  double low_score = score(low);
  double high = low;
  double high_score = low_score;
  while (high_score > 0.0) {
    low = high;
    low_score = high_score;
    high_score = score(high += kFactor);
  }
  while (sign(low_score) == 0 && low_score != 0.0 && low > least) {
    high = low;
    high_score = low_score;
    low_score = score(low -= kFactor);
  }
  if (low_score <= 0.0) return low;
  if (high_score == 0.0) return high;
  std::uintmax_t evaluations = 100;
  const auto [from, to] = boost::math::tools::toms748_solve(
      [&](double x) { return score(x); }, low, high, low_score, high_score,
      boost::math::tools::eps_tolerance<double>(std::numeric_limits<double>::digits - 4), evaluations);
  return from + (to - from) / 2.0;
}

}  // namespace

Eigen::VectorXd linear_predictor(const CountDesign& design, const Eigen::VectorXd& coefficients) {
  Eigen::VectorXd eta = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(design.columns.size()));
  for (std::size_t c = 0; c < design.columns.size(); ++c) {
    for (const auto column : design.columns[c]) eta[static_cast<Eigen::Index>(c)] += coefficients[column];
  }
  return eta;
}

Eigen::MatrixXd expected_information(const CountData& data, const CountDesign& design, const CountFit& fit) {
  Eigen::VectorXd weights = linear_predictor(design, fit.coefficients).array().exp();
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    double& mu = weights[static_cast<Eigen::Index>(c)];
    mu *= data.cells[c].observations / (1.0 + fit.alpha * mu);
  }
  return weighted_products(design, weights);
}

std::optional<CountFit> fit_poisson(const CountData& data, const CountDesign& design) {
  const auto coefficients = fit_coefficients(data, design, 0.0, first_guess(data, design));
  if (!coefficients) return std::nullopt;
  return CountFit{0.0, *coefficients, log_likelihood(data, design, *coefficients, 0.0)};
}

std::optional<CountFit> fit_negative_binomial(const CountData& data, const CountDesign& design) {
  auto poisson = fit_poisson(data, design);
  if (!poisson) return std::nullopt;
  const Eigen::VectorXd mu = linear_predictor(design, poisson->coefficients).array().exp();
  const double excess = excess_variance(data, mu);
  if (excess <= kLeastExcess * data.sum) return poisson;
  double sum_of_squares = 0.0;
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    const double mu_c = mu[static_cast<Eigen::Index>(c)];
    sum_of_squares += data.cells[c].observations * mu_c * mu_c;
  }
  ProfileScore score{data, design, poisson->coefficients};
  const double least = std::log(kLeastExcess * data.sum / sum_of_squares);
  const double log_alpha = find_root(score, std::log(excess / sum_of_squares), least);
  if (log_alpha <= least) return poisson;
  const double alpha = std::exp(log_alpha);
  const auto coefficients = fit_coefficients(data, design, alpha, score.coefficients());
  if (!coefficients || score.failed()) return std::nullopt;
  return CountFit{alpha, *coefficients, log_likelihood(data, design, *coefficients, alpha)};
}

}  // namespace kith::detail
