#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kith/core/stream.hpp"
#include "models.hpp"
#include "scenario.hpp"

namespace kith::faults {

/// Does damage of family flip, truncate or mix to what lies below `root`:
///
///     flip      run/study.sqlite:81234         turns over this bit
///     truncate  run/study.sqlite:4096          leaves so many bytes; "gone" removes the file
///     mix       run/inputs=seed.finished/inputs
///
/// A mixture takes the place of a file, of a folder, or of all files whose names begin so ("study.sqlite*"), by those
/// of a model. Returns whether that changed anything. @throws kith::Error if there is no such file or damage
bool do_damage(const std::string& family, const std::string& fault, const std::filesystem::path& root,
               const Models& models);

/// The file or folder that such a fault is done to.
[[nodiscard]] std::string damaged_name(const std::string& fault);

/// Draws damage of a family to a folder whose name begins with `only`; `root` is as the scenario prepares it. Empty if
/// there is nothing to damage.
[[nodiscard]] std::string draw_damage(const std::string& family, const std::filesystem::path& root,
                                      const std::string& only, const Models& models, RandomStream& random);

}  // namespace kith::faults
