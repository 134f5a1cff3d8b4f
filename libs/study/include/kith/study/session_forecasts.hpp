#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/study/records.hpp"
#include "kith/study/study_spec.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/forecast.hpp"

namespace kith {

/// Imagined sessions of a crew: `n` teams of the composition, drawn from the study's learner types, are taught by the
/// strategy; minutes are those of the study's pace. People and chance are others than those of the study's teams.
/// @param cache  of the calling thread; influences nothing.
[[nodiscard]] std::vector<PastSession> imagine_sessions(const Atlas& atlas, TeachingCache& cache, const StudySpec& spec,
                                                        const std::string& strategy, const std::string& composition,
                                                        std::size_t n);

/// What the record of a team says about its sessions. @pre it has records of periods.
[[nodiscard]] PastSession past_session(const TeamRecord& team, const StudySpec& spec, std::size_t num_components);

/// What is expected before the first lesson: means and the limits of the central 80 %.
[[nodiscard]] TeamForecast forecast_of(const RemainingTime& all);

/// Imagined sessions for all cells of a study, each imagined when first asked for. Safe for several threads.
class SessionForecasts {
 public:
  /// Those of the cell of a team; StudySpec::forecast_sessions of them.
  /// @param spec  of the team's variant, always the same for one variant.
  [[nodiscard]] const std::vector<PastSession>& like(const Atlas& atlas, TeachingCache& cache, const StudySpec& spec,
                                                     const TeamAddress& address);

 private:
  struct Cell {
    std::once_flag once;
    std::vector<PastSession> sessions;
  };
  std::mutex mutex_;
  std::map<std::tuple<std::size_t, std::string, std::string>, std::unique_ptr<Cell>> cells_;
};

}  // namespace kith
