// The options of every command. With command_line.cpp the only file that includes CLI11, which takes long to compile.
#include "option_declarations.hpp"

#include <CLI/CLI.hpp>
#include <cctype>
#include <limits>
#include <map>

#include "kith/teaching/strategy.hpp"
#include "option_values.hpp"

namespace kith::cli {
namespace {

std::string variable_of(const std::string& long_name) {
  std::string name = "KITH_";
  for (const char c : long_name)
    name += c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

std::string braces(const std::vector<std::string>& words) {
  std::string text = "{";
  for (const auto& word : words) text += (text.size() > 1 ? "," : "") + word;
  return text + "}";
}

// An option whose value is one of a few words; help and completion list them.
CLI::Option& takes_word(CLI::Option& option, const std::string& type, const std::vector<std::string>& words) {
  return *option.check([words](const std::string& text) { return wrong_word(text, words); })
              ->type_name(type + ":" + braces(words));
}

CLI::Option& takes_integer(CLI::Option& option, std::int64_t min,
                           std::int64_t max = std::numeric_limits<std::int64_t>::max()) {
  return *option.check([min, max](const std::string& text) { return wrong_integer(text, min, max); })->type_name("N");
}

template <typename Mode>
void add_mode(CLI::App& command, const std::string& name, Mode& mode, const std::string& description,
              const std::string& type, const std::vector<std::pair<std::string, Mode>>& modes) {
  std::vector<std::string> words;
  for (const auto& one : modes) words.push_back(one.first);
  const auto set = [&mode, modes](const std::string& text) {
    for (const auto& one : modes) {
      if (one.first == text) mode = one.second;
    }
  };
  takes_word(*command.add_option_function<std::string>(name, set, description), type, words);
}

// Every option can be set in the environment; help and completion are written by us.
void add_common(CLI::App& command, CommonOptions& common) {
  command.set_help_flag();
  command.add_flag("--json", common.json, "Print one JSON document instead of text");
  add_mode<ColorMode>(command, "--color", common.color, "Colours on a terminal", "WHEN",
                      {{"auto", ColorMode::kAuto}, {"always", ColorMode::kAlways}, {"never", ColorMode::kNever}});
  command.add_flag("-q,--quiet", common.quiet, "Only results and errors");
  command.add_flag("-v,--verbose", common.verbosity, "Say more about what is done; twice: even more");
  for (auto* option : command.get_options()) {
    if (!option->get_lnames().empty()) option->envname(variable_of(option->get_lnames().front()));
  }
}

void add_validate(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("validate", "Check domain and study files");
  command.add_option("files", options.validate.files, "Files to check; '-' is standard input")
      ->required()
      ->type_name("FILE");
  command.add_flag("--strict", options.validate.strict, "Let warnings count as errors");
  add_common(command, options.common);
}

void add_inspect(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("inspect", "Show a domain: map, reward, policy, and what can be taught about it");
  command.add_option("domain", options.inspect.domain, "Built-in domain or file")->required()->type_name("DOMAIN");
  takes_word(*command.add_option("--show", options.inspect.show, "What to show, separated by commas")
                  ->delimiter(',')
                  ->allow_extra_args(false),
             "PARTS", inspect_parts());
  takes_integer(*command.add_option("--mdp", options.inspect.mdp,
                                    "Number of the MDP to show (default: the last, with everything)"),
                0);
  command.add_flag("--all", options.inspect.all, "Do not cut long lists short");
  add_common(command, options.common);
}

void add_teach(CLI::App& app, Options& options) {
  auto& teach = options.teach;
  std::vector<std::string> names;
  for (const auto& entry : strategies()) names.emplace_back(entry.name);
  auto& command = *app.add_subcommand("teach", "Teach one simulated team and print a transcript");
  auto* domain = command.add_option("domain", teach.domain, "Built-in domain or file")->type_name("DOMAIN");
  auto* group =
      command.add_option("--group", teach.group, "The members' learner types, one letter each")->type_name("LETTERS");
  auto* strategy =
      &takes_word(*command.add_option("--strategy", teach.strategy, "Whose belief the lessons are chosen for")
                       ->capture_default_str(),
                  "NAME", names);
  auto* seed =
      &takes_integer(*command.add_option("--seed", teach.seed, "Root of all random streams")->capture_default_str(), 0);
  auto* study = command.add_option("--study", teach.study, "Built-in study or file with the learner types")
                    ->capture_default_str()
                    ->type_name("STUDY");
  auto* set = command.add_option("--set", teach.set, "Set a key of the study (may be repeated)")
                  ->allow_extra_args(false)
                  ->type_name("KEY=VALUE");
  auto* from = command.add_option("--from", teach.from, "Replay a team of this run folder")->type_name("DIR");
  auto* team = command.add_option("--team", teach.team, "Number of the team, as in teams.csv")->type_name("N");
  from->needs(team);
  team->needs(from);
  for (auto* other : {domain, group, strategy, seed, study, set}) from->excludes(other);
  add_common(command, options.common);
}

void add_study(CLI::App& app, Options& options) {
  auto& study = options.study;
  auto& command = *app.add_subcommand("study", "Simulate all teams of a study and write its tables");
  command.add_option("study", study.study, "Built-in study or file; '-' is standard input")
      ->required()
      ->type_name("STUDY");
  command.add_option("-o,--out", study.out, "Run folder to make or to bring up to date")->type_name("DIR");
  takes_integer(*command.add_option("-j,--threads", study.threads,
                                    "Worker threads (default: one per core); never changes a result"),
                1, 1024);
  takes_integer(*command.add_option("--seed", study.seed, "The same as --set seed=N"), 0);
  command.add_option("--set", study.set, "Set a key of the study (may be repeated)")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command.add_flag("--dry-run", study.dry_run, "Say what would be run, and run nothing");
  command.add_flag("--yes", study.yes, "Replace the results of a different study in the run folder");
  add_mode<ProgressMode>(command, "--progress", study.progress, "How to show progress, on stderr", "HOW",
                         {{"auto", ProgressMode::kAuto},
                          {"bar", ProgressMode::kBar},
                          {"json", ProgressMode::kJson},
                          {"none", ProgressMode::kNone}});
  add_common(command, options.common);
}

void add_progress(CLI::App& command, ProgressMode& mode) {
  add_mode<ProgressMode>(command, "--progress", mode, "How to show progress, on stderr", "HOW",
                         {{"auto", ProgressMode::kAuto},
                          {"bar", ProgressMode::kBar},
                          {"json", ProgressMode::kJson},
                          {"none", ProgressMode::kNone}});
}

void add_calibrate(CLI::App& app, Options& options) {
  auto& calibrate = options.calibrate;
  auto& command = *app.add_subcommand("calibrate", "Fit a study's free parameters to published figures");
  command.add_option("study", calibrate.study, "Built-in study or file; '-' is standard input")
      ->required()
      ->type_name("STUDY");
  command.add_option("--targets", calibrate.targets, "File with the figures, their tolerances and the free parameters")
      ->type_name("FILE");
  command.add_option("-o,--out", calibrate.out, "Write the calibrated study to this file")->type_name("FILE");
  takes_integer(*command.add_option("-j,--threads", calibrate.threads,
                                    "Worker threads (default: one per core); never changes a result"),
                1, 1024);
  takes_integer(*command.add_option("--seed", calibrate.seed, "Root of all random streams of the search (default: 1)"),
                0);
  takes_integer(*command.add_option("--teams", calibrate.teams, "Teams per cell for each setting tried (default: 20)"),
                2, 100'000);
  takes_integer(*command.add_option("--confirm", calibrate.confirm,
                                    "Teams per cell to confirm the best settings (default: ten times --teams)"),
                2, 1'000'000);
  command.add_flag("--quick", calibrate.quick, "A coarse search in a tenth of the time");
  command.add_option("--set", calibrate.set, "Set a key of the study (may be repeated)")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command.add_flag("--yes", calibrate.yes, "Replace the file of -o if there is one");
  add_progress(command, calibrate.progress);
  add_common(command, options.common);
}

void add_others(CLI::App& app, Options& options) {
  auto& doctor = *app.add_subcommand("doctor", "Check that this machine runs kith as it should");
  add_common(doctor, options.common);
  auto& completion = *app.add_subcommand("completion", "Print a shell's completion script");
  takes_word(*completion.add_option("shell", options.completion.shell, "The shell")->required(), "SHELL",
             {"bash", "zsh", "fish"});
  add_common(completion, options.common);
  auto& version = *app.add_subcommand("version", "Print version, commit and compiler (also: kith --version)");
  add_common(version, options.common);
}

}  // namespace

std::unique_ptr<CLI::App> make_app(Options& options) {
  auto app = std::make_unique<CLI::App>("Teach a robot's policy to a group of people by demonstration", "kith");
  app->set_help_flag();
  app->require_subcommand(1);
  add_validate(*app, options);
  add_inspect(*app, options);
  add_teach(*app, options);
  add_study(*app, options);
  add_calibrate(*app, options);
  add_others(*app, options);
  return app;
}

Command command_of(const std::string& name) {
  static const std::map<std::string, Command> kCommands{
      {"validate", Command::kValidate}, {"inspect", Command::kInspect},    {"teach", Command::kTeach},
      {"study", Command::kStudy},       {"doctor", Command::kDoctor},      {"completion", Command::kCompletion},
      {"version", Command::kVersion},   {"calibrate", Command::kCalibrate}};
  return kCommands.at(name);
}

const std::vector<std::string>& inspect_parts() {
  static const std::vector<std::string> kParts{"map", "policy", "bec", "kc", "demos", "tests", "counterfactuals"};
  return kParts;
}

}  // namespace kith::cli
