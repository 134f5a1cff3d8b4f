#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/study/study_file.hpp"
#include "measure.hpp"

namespace kith::bench {

/// What cases have in common and is made when it is first asked for.
class Workbench {
 public:
  /// @param threads  of what runs on all threads, at least 1.
  explicit Workbench(std::size_t threads) : threads_{threads} {}

  [[nodiscard]] std::size_t threads() const noexcept { return threads_; }
  /// Of item delivery.
  [[nodiscard]] const Atlas& atlas();
  /// A built-in study.
  [[nodiscard]] static StudyReading study(const std::string& name);

 private:
  std::size_t threads_;
  std::unique_ptr<const Atlas> atlas_;
};

/// A case with its data at hand. Work may share data with its rival, so both are done on one thread, in turns.
struct Prepared {
  Work work;
  Work rival;  ///< Empty if the case has none.
  std::function<std::string()>
      disagreement;  ///< How the rival's result differs from kith's; empty text if it does not.
};

/// Something that is timed.
struct Case {
  std::string name;   ///< LAYER.WHAT
  std::string what;   ///< One round of it.
  std::string rival;  ///< What the rival does; empty: there is none.
  Clock clock = Clock::kCpu;
  bool is_study = false;  ///< Takes a second rather than microseconds.
  std::function<Prepared(Workbench&)> prepare;
};

/// Every case, the lowest layer first.
[[nodiscard]] const std::vector<Case>& all_cases();

/// How cost grows with one size, everything else as in the paper's study.
struct Growth {
  std::string name;  ///< growth.WHAT
  std::string what;  ///< What is timed.
  std::string size;  ///< What grows: "particles".
  Clock clock = Clock::kCpu;
  struct Point {
    double size = 0.0;
    std::function<Work(Workbench&)> prepare;
    double per = 1.0;  ///< A round's time is divided by this: by the teams, for a time per team.
  };
  std::vector<Point> points;
};

/// Every growth.
[[nodiscard]] const std::vector<Growth>& all_growths();

/// The slope of log(cost) over log(size) by least squares: 1 for linear growth. @pre two sizes at least, all positive.
[[nodiscard]] double growth_exponent(const std::vector<double>& sizes, const std::vector<double>& costs);

// By layer, for all_cases().
void add_belief_cases(std::vector<Case>& cases);
void add_geometry_cases(std::vector<Case>& cases);
void add_planning_cases(std::vector<Case>& cases);
void add_study_cases(std::vector<Case>& cases);

}  // namespace kith::bench
