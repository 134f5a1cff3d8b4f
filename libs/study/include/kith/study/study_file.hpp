#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/domains/domain.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/study/study.hpp"

namespace kith {

/// What came of reading a study file: the study and its domain unless there are
/// errors, and everything worth saying about the file, in file order.
struct StudyReading {
  std::optional<Study> study;
  std::optional<Domain> domain;
  std::string domain_text;               ///< The TOML text of the domain.
  std::vector<DomainFile> domain_files;  ///< The files that the domain file names.
  std::vector<Diagnostic> diagnostics;   ///< Of the study file, the overrides and the domain file.
};

struct StudyReadOptions {
  /// "KEY=VALUE" each, KEY dotted, VALUE any TOML value ("teacher.process_noise=0.5"); later ones win.
  std::vector<std::string> overrides{};
  /// Where a domain file named by the study is looked for; one named by an override is relative to the working
  /// directory.
  std::filesystem::path folder{};
  StudyKinds kinds{};
  std::string override_name = "override";  ///< What diagnostics name in place of a file if an override is wrong.
};

/// Parses and checks a study file (schema kith.study/1, see docs/study-files.md) with the overrides applied, reads
/// its domain, and expands the varied keys: every combination of their values is one variant, the first key slowest.
/// All errors are reported at once (at most 20 of one file); `name` is used in messages. Never throws for bad content.
[[nodiscard]] StudyReading parse_study(std::string_view text, const std::string& name,
                                       const StudyReadOptions& options = {});

/// A study that comes with kith.
struct BuiltInStudy {
  std::string_view name;  ///< "paper"
  std::string_view text;  ///< The TOML file, embedded when kith was built.
};
[[nodiscard]] const std::vector<BuiltInStudy>& built_in_studies();

/// A built-in study by name, or the study file at that path, which is what `options.folder` is then set to.
/// @throws kith::Error (kInvalidInput, E0116) if there is neither; kIo if the file cannot be read.
[[nodiscard]] StudyReading load_study(const std::string& name_or_path, StudyReadOptions options = {});

/// Whether `[group]` is written: it says how people are taught and changes nothing in what a study simulates, so the
/// identity of a run does not depend on it.
enum class GroupText { kLeftOut, kWritten };

/// The study as a study file with every key written out; reading it gives the same study again, without `[group]`
/// unless that is asked for.
/// @param domain  the study's domain, for the names of features.
[[nodiscard]] std::string to_toml(const Study& study, const Domain& domain, GroupText group = GroupText::kLeftOut);

}  // namespace kith
