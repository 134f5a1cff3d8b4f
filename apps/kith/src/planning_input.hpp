#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study_design/targets.hpp"

namespace kith::cli {

/// The text of a study, read once, that can be parsed again and again with different overrides.
class StudyText {
 public:
  /// @param overrides  of the command line; later ones given to read() win.
  /// @throws kith::Error if there is no such study or it has errors.
  StudyText(const std::string& name, std::vector<std::string> overrides);
  [[nodiscard]] StudyReading read(const std::vector<std::string>& overrides) const;
  /// Where a domain file that it names is looked for.
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  std::string name_;
  std::string text_;
  std::filesystem::path folder_;
  std::vector<std::string> overrides_;
};

/// @throws kith::Error (E0812) if keys vary within the study.
void check_single_variant(const std::string& name, const Study& study);

/// The targets file, "-" for standard input. @throws kith::Error with all that is wrong.
[[nodiscard]] TargetSet targets_of(const std::string& file, const StudyText& study);

/// "simulating 6000 teams takes about 12 s", from the time that one team of every cell takes; those are simulated and
/// forgotten.
/// @param teams  in all.
[[nodiscard]] std::string work_text(const Atlas& atlas, const StudySpec& spec, std::size_t threads, std::size_t teams);

/// "less than a second", "12 s", "3 min", "2.5 h".
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace kith::cli
