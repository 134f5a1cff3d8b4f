#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kith::cli {

enum class Command {
  kReport,
  kValidate,
  kInspect,
  kTeach,
  kStudy,
  kDoctor,
  kCompletion,
  kVersion,
  kCalibrate,
  kPower,
  kAnalyze,
  kFit,
  kStatus,
  kVerify,
  kMerge,
  kExport,
  kCurriculum,
  kAsk,
  kFind,
  kInit,
  kExplain,
  kServe,
  kSession,
  kAudit
};
enum class ColorMode { kAuto, kAlways, kNever };
enum class ProgressMode { kAuto, kBar, kJson, kNone };
enum class ResumeMode { kAuto, kNever, kRequire };

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
  std::string svg;                 ///< Folder for pictures; empty: none.
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
  std::optional<std::size_t> forecast;  ///< Imagined sessions; none: as the study says.
};

/// "2/7": part 2 of 7.
struct ShardOption {
  std::size_t index = 1;
  std::size_t count = 1;
};

struct StudyOptions {
  std::string study;
  std::string out;
  std::optional<std::uint64_t> seed;
  std::size_t threads = 0;  ///< 0: as many as there are cores. Changes the speed, never the results.
  std::vector<std::string> set;
  bool dry_run = false;
  bool yes = false;  ///< Replace the results of a different study.
  ResumeMode resume = ResumeMode::kAuto;
  ShardOption shard;
  bool keep_going = false;  ///< Go on after a team that failed.
  ProgressMode progress = ProgressMode::kAuto;
};

struct StatusOptions {
  std::string folder;
};

struct AuditCommandOptions {
  std::string folder;
  std::optional<std::size_t> team;  ///< Number of a team of a run; none: all.
  std::string room;                 ///< Id or code of a room of a live session; empty: all.
  std::string out;                  ///< Where the page goes; "-" is standard output; empty: no page.
  double forgetting = 0.02;         ///< Radians per period without lessons.
  std::size_t threads = 0;          ///< 0: as many as there are cores.
  ProgressMode progress = ProgressMode::kAuto;
};

struct VerifyCommandOptions {
  std::string folder;
  std::string sample = "1";  ///< Share of the teams to teach again.
  std::size_t threads = 0;   ///< 0: as many as there are cores.
  ProgressMode progress = ProgressMode::kAuto;
};

struct MergeOptions {
  std::vector<std::string> folders;
  std::string out;
  bool yes = false;            ///< Replace the results of a different study.
  bool allow_partial = false;  ///< Leave out what is missing or damaged, and say so.
};

struct ExportOptions {
  std::string domain;
  std::string format;              ///< One of model_format_names().
  std::optional<std::size_t> mdp;  ///< Needed where the domain has several.
  std::string out;                 ///< A file, or with "prism" what the names of all files begin with; "-": stdout.
  bool yes = false;                ///< Replace files that are there.
};

struct AnalyzeOptions {
  std::string input;                     ///< Run folder, CSV file, or "-" for standard input.
  std::string model;                     ///< A formula; empty: the analyses of a study.
  std::string table = "teams";           ///< Of a run folder, for the model.
  std::string observed;                  ///< Column that tells counts that were not cut off; empty: none was.
  std::vector<std::string> where;        ///< Rows to keep, "COLUMN=VALUE" or "COLUMN!=VALUE".
  std::vector<std::string> identifiers;  ///< Columns that name who or what a row is about, besides the obvious ones.
  bool independent = false;              ///< Rows are independent although identifiers repeat.
  bool counts = false;                   ///< The response is a count.
  bool ordinal = false;                  ///< The response is a rating, of which only the order counts.
  std::string latex;                     ///< File for all findings as LaTeX; empty: none.
  std::string csv;                       ///< Folder for every table as CSV; empty: none.
  std::string r;                         ///< Folder for data and a script that repeats the analysis in R; empty: none.
  std::vector<std::string> contrasts;    ///< "NAME [FACTOR]: TERMS", see parse_contrast().
  std::vector<std::string> by;           ///< Factors at each level of which others are compared.
  std::string smallest_effect;           ///< "0.5" or "d=0.3"; empty: no tests of equivalence.
  std::string codebook;                  ///< File that describes the columns; empty: codebook.json beside the table.
  double alpha = 0.05;
  std::string correction = "bonferroni";
  std::uint64_t seed = 1;
  std::size_t permutations = 999;
  bool brief = false;  ///< Findings in words, without tables.
};

struct ReportCommandOptions {
  std::string folder;
  std::string out;  ///< "-" is standard output; empty: report.html in the folder.
};

struct FitCommandOptions {
  std::vector<std::string> logs;  ///< Run folders, tables of trials, or the tables of 2021.
  std::string method = "likelihood";
  std::string answers = "path";  ///< What of an answer counts: "path" or "verdict".
  std::string out;               ///< File for the JSON result; empty: none.
  std::size_t types = 0;         ///< Types without labels; 0: as labelled.
  std::size_t folds = 5;         ///< Of the cross-validation; 0: none.
  std::size_t replicates = 2;    ///< Runs of the filter per person.
  std::uint64_t seed = 1;
  std::size_t threads = 0;  ///< 0: as many as there are cores. Changes the speed, never the results.
  bool yes = false;         ///< Replace an existing file.
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

struct PowerCommandOptions {
  std::string study;
  std::vector<std::string> effects;
  std::string target = "0.8";
  std::string alpha = "0.05";
  std::vector<std::uint32_t> teams;  ///< Per cell; empty: a range of sizes, or those of the study.
  std::optional<std::size_t> pool;   ///< Teams per cell to draw studies from.
  std::size_t draws = 1000;
  bool paired = false;
  std::string findings;     ///< A targets file: repeat the study and look for its findings.
  std::string preregister;  ///< File for a preregistration of the study; empty: none.
  std::size_t studies = 200;
  std::optional<std::uint64_t> seed;
  std::size_t threads = 0;  ///< 0: as many as there are cores. Changes the speed, never the results.
  std::vector<std::string> set;
  ProgressMode progress = ProgressMode::kAuto;
};

struct CurriculumCommandOptions {
  std::string domain;
  std::string out;  ///< Where the page goes; "-" is standard output; empty: no page.
  std::uint64_t seed = 1;
};

struct AskOptions {
  std::string domain;
  std::vector<std::string> question;  ///< In one argument or in several.
};

struct FindOptions {
  std::string domain;
  std::vector<std::string> constraint;  ///< A normal or a sentence, in one argument or in several; empty: list all.
  bool test = false;                    ///< Wanted for a test rather than for a demonstration.
  bool no_make = false;                 ///< Make no world where the family has none.
  std::string out;                      ///< Where the world goes as a domain file; empty: nowhere.
};

struct InitOptions {
  std::string folder = ".";
  std::string template_name = "item-delivery";
};

struct ExplainOptions {
  std::string id;  ///< "E0207", or a list of kinds ("strategies"); empty: list all ids.
};

struct ServeOptions {
  std::string study;
  std::vector<std::string> set;
  std::string out;                    ///< Folder of the session; empty: a temporary one.
  std::optional<std::uint16_t> port;  ///< 0: any that is free.
  std::string bind;                   ///< An address; empty: this machine alone, or with `lan` every one.
  bool lan = false;
  bool insecure_lan = false;  ///< Unencrypted through the network.
  std::string public_url;     ///< What a reverse proxy in front is called.
  std::string trusted_proxy;  ///< Its address if it is not on this machine.
  std::size_t rooms = 0;      ///< Rooms to make at the start.
  std::size_t join_limit = 120;
  std::size_t connections_per_address = 1024;
  bool demo = false;
  bool no_browser = false;
  std::size_t rehearse = 0;  ///< Groups of simulated people; 0: no rehearsal.
  double for_seconds = 0.0;  ///< 0: until everybody has finished.
  double answer_every = 5.0;
  double reconnects = 0.0;
  double restart_after = 0.0;  ///< Seconds after which a rehearsal restarts its server; 0: never.
};

struct SessionOptions {
  std::string action;  ///< One of session_actions().
  std::string folder;
  std::string room;    ///< Id or code; empty: all rooms.
  std::string out;     ///< Folder for tables or for the recovered session.
  bool names = false;  ///< Export what identifies people, too.
  bool text = false;   ///< Export what people wrote in their own words, too.
  bool yes = false;    ///< Replace an existing export; erase for good.
};

/// One command line, understood.
struct Options {
  Command command = Command::kVersion;
  CommonOptions common;
  ValidateOptions validate;
  InspectOptions inspect;
  TeachOptions teach;
  StudyOptions study;
  AnalyzeOptions analyze;
  ReportCommandOptions report;
  CompletionOptions completion;
  CalibrateOptions calibrate;
  PowerCommandOptions power;
  FitCommandOptions fit;
  StatusOptions status;
  AuditCommandOptions audit;
  VerifyCommandOptions verify;
  MergeOptions merge;
  ExportOptions export_model;
  CurriculumCommandOptions curriculum;
  AskOptions ask;
  FindOptions find;
  InitOptions init;
  ExplainOptions explain;
  ServeOptions serve;
  SessionOptions session;
};

/// What `kith inspect --show` can show.
[[nodiscard]] const std::vector<std::string>& inspect_parts();
/// What `kith session` can do.
[[nodiscard]] const std::vector<std::string>& session_actions();

}  // namespace kith::cli
