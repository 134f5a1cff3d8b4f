#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "kith/live/live_study.hpp"
#include "kith/study/study_file.hpp"

namespace kith {

/// A study as rooms need it, with the texts that it can be made from again.
struct SessionStudy {
  std::shared_ptr<const LiveStudy> study;
  std::map<std::string, std::string> inputs;  ///< "study.toml", "domain.toml" and the files that they name.
  std::string digest;                         ///< Of the inputs, 64 hexadecimal digits.
};

/// The study of a reading without errors, for live groups.
/// @param folder  where consent_file and language are looked for.
/// @throws kith::Error as make_live_study(); std::invalid_argument if the reading has no study.
[[nodiscard]] SessionStudy make_session_study(const StudyReading& reading, const std::filesystem::path& folder = {});

/// The same study again, from its inputs. @throws kith::Error (kMismatch, E1617) if they are not such inputs.
[[nodiscard]] SessionStudy restore_session_study(const std::map<std::string, std::string>& inputs);

}  // namespace kith
