#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kith::cli {

enum class Command { kValidate, kInspect, kTeach, kStudy, kDoctor, kCompletion, kVersion, kCalibrate };
enum class ColorMode { kAuto, kAlways, kNever };
enum class ProgressMode { kAuto, kBar, kJson, kNone };

/// What every command understands.
struct CommonOptions {
  bool json = false;
  ColorMode color = ColorMode::kAuto;
  bool quiet = false;
  int verbosity = 0;  ///< Number of -v.
};

struct ValidateOptions {
  std::vector<std::string> files;  ///< "-" is standard input.
  bool strict = false;             ///< Warnings count as errors.
};

struct InspectOptions {
  std::string domain;
  std::vector<std::string> show;   ///< Some of inspect_parts(); empty: the overview.
  std::optional<std::size_t> mdp;  ///< The MDP whose map, policy or demonstrations are shown.
  bool all = false;                ///< No list is cut short.
};

struct TeachOptions {
  std::string domain;
  std::string group;
  std::string strategy = "common";
  std::uint64_t seed = 1;
  std::string study = "paper";  ///< Where learner types and the teacher's settings come from.
  std::vector<std::string> set;
  std::string from;  ///< A run folder ...
  std::string team;  ///< ... and the number of one of its teams, as typed: only the folder tells how many there are.
};

struct StudyOptions {
  std::string study;
  std::string out;
  std::optional<std::uint64_t> seed;
  std::size_t threads = 0;  ///< 0: as many as there are cores. Changes the speed, never the results.
  std::vector<std::string> set;
  bool dry_run = false;
  bool yes = false;  ///< Replace the results of a different study.
  ProgressMode progress = ProgressMode::kAuto;
};

struct CompletionOptions {
  std::string shell;
};

struct CalibrateOptions {
  std::string study;
  std::string targets;  ///< "-" is standard input.
  std::string out;      ///< The study file to write; empty: none.
  std::optional<std::uint64_t> seed;
  std::size_t threads = 0;             ///< 0: as many as there are cores. Changes the speed, never the results.
  std::optional<std::size_t> teams;    ///< Per cell and setting tried.
  std::optional<std::size_t> confirm;  ///< Per cell, to confirm the best settings.
  bool quick = false;
  bool yes = false;  ///< Replace an existing file.
  std::vector<std::string> set;
  ProgressMode progress = ProgressMode::kAuto;
};

/// One command line, understood.
struct Options {
  Command command = Command::kVersion;
  CommonOptions common;
  ValidateOptions validate;
  InspectOptions inspect;
  TeachOptions teach;
  StudyOptions study;
  CompletionOptions completion;
  CalibrateOptions calibrate;
};

/// What `kith inspect --show` can show.
[[nodiscard]] const std::vector<std::string>& inspect_parts();

}  // namespace kith::cli
