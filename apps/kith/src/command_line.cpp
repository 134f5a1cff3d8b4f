// The only file that includes CLI11, which takes long to compile.
#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <limits>
#include <map>

#include "help.hpp"
#include "kith/core/diagnostic.hpp"
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

std::unique_ptr<CLI::App> make_app(Options& options) {
  auto app = std::make_unique<CLI::App>("Teach a robot's policy to a group of people by demonstration", "kith");
  app->set_help_flag();
  app->require_subcommand(1);
  add_validate(*app, options);
  add_inspect(*app, options);
  add_teach(*app, options);
  add_study(*app, options);
  add_others(*app, options);
  return app;
}

Command command_of(const std::string& name) {
  static const std::map<std::string, Command> kCommands{
      {"validate", Command::kValidate}, {"inspect", Command::kInspect}, {"teach", Command::kTeach},
      {"study", Command::kStudy},       {"doctor", Command::kDoctor},   {"completion", Command::kCompletion},
      {"version", Command::kVersion}};
  return kCommands.at(name);
}

// "NAME:{a,b}" -> "NAME" and {a, b}.
OptionDescription describe(const CLI::Option& option) {
  OptionDescription result;
  for (const auto& name : option.get_snames()) result.names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) result.names.push_back("--" + name);
  result.positional = result.names.empty();
  std::string type = option.get_type_size() == 0 ? "" : option.get_type_name();
  const auto open = type.find(":{");
  if (open != std::string::npos) {
    const auto close = type.find('}', open);
    for (auto& word : CLI::detail::split(type.substr(open + 2, close - open - 2), ',')) result.choices.push_back(word);
    type.resize(open);
  }
  result.value = type.substr(0, type.find(':'));
  if (result.positional) result.names.push_back(result.value);
  result.description = option.get_description();
  result.default_text = option.get_default_str();
  result.environment = option.get_envname();
  result.required = option.get_required();
  result.many = option.get_items_expected_max() > 1;
  return result;
}

CommandDescription describe(const CLI::App& command) {
  CommandDescription result{command.get_name(), command.get_description(), examples_of(command.get_name()), {}};
  for (const auto* option : command.get_options()) result.options.push_back(describe(*option));
  result.options.push_back({{"-h"}, "", "Short help with examples", "", {}, "", false, false, false});
  result.options.push_back({{"--help"}, "", "Full help", "", {}, "", false, false, false});
  return result;
}

// The mend for what CLI11 did not understand.
UsageError explain(const CLI::App& command, const std::string& what, const std::vector<std::string>& arguments) {
  UsageError error{what, "", command.get_name()};
  const auto left = command.remaining();
  if (left.empty()) return explain_value(describe(command), what, arguments);
  const auto option = std::find_if(left.begin(), left.end(), [](const auto& word) { return word.rfind('-', 0) == 0; });
  if (option == left.end()) {
    error.message = "unexpected argument '" + left.front() + "'";
    return error;
  }
  const auto name = option->substr(0, option->find('='));
  std::vector<std::string> known{"--help", "-h"};
  for (const auto* one : command.get_options()) {
    for (const auto& text : describe(*one).names) known.push_back(text);
  }
  error.message = "unknown option '" + name + "'";
  const auto nearest = name.rfind("--", 0) == 0 ? nearest_word(name, known) : "";
  if (!nearest.empty()) error.hint = "did you mean '" + nearest + "'?";
  return error;
}

ParsedCommandLine parse_command(Options& options, CLI::App& app, const std::vector<std::string>& arguments) {
  ParsedCommandLine result;
  const auto& command = *app.get_subcommand(arguments.front());
  auto reversed = arguments;
  std::reverse(reversed.begin(), reversed.end());
  try {
    app.parse(reversed);
    options.command = command_of(command.get_name());
    result.options = options;
  } catch (const CLI::ParseError& error) {
    result.error = explain(command, error.what(), arguments);
  }
  return result;
}

std::optional<std::string> asked_help(const std::vector<std::string>& arguments) {
  for (const auto& argument : arguments) {
    if (argument == "--") break;
    if (argument == "-h" || argument == "--help") return argument;
  }
  return std::nullopt;
}

}  // namespace

const std::vector<std::string>& inspect_parts() {
  static const std::vector<std::string> kParts{"map", "policy", "bec", "kc", "demos", "tests", "counterfactuals"};
  return kParts;
}

std::vector<CommandDescription> describe_commands() {
  Options options;
  const auto app = make_app(options);
  std::vector<CommandDescription> result;
  for (const auto* command : app->get_subcommands(nullptr)) result.push_back(describe(*command));
  return result;
}

ParsedCommandLine parse_command_line(const std::vector<std::string>& given) {
  ParsedCommandLine result;
  auto arguments = given;
  if (!arguments.empty() && arguments.front() == "help") {  // `kith help study` is `kith study --help`
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  const bool version = !arguments.empty() && (arguments.front() == "--version" || arguments.front() == "-V");
  if (version) arguments.front() = "version";
  // `kith --json --version` is the same as `kith --version --json`.
  if (arguments.size() == 2 && arguments[0] == "--json" && arguments[1] == "--version")
    arguments = {"version", "--json"};
  const auto commands = describe_commands();
  const auto help = asked_help(arguments);
  if (arguments.empty() || (help && arguments.front() == *help)) {
    result.text = help_text(commands, help == "--help");
    return result;
  }
  const auto& name = arguments.front();
  const auto known = std::find_if(commands.begin(), commands.end(), [&](const auto& one) { return one.name == name; });
  if (known == commands.end()) {
    std::vector<std::string> names{"--version", "--help", "help"};
    for (const auto& command : commands) names.push_back(command.name);
    const auto nearest = nearest_word(name, names);
    result.error = UsageError{(name.rfind('-', 0) == 0 ? "unknown option '" : "unknown command '") + name + "'",
                              nearest.empty() ? "" : "did you mean '" + nearest + "'?", ""};
    return result;
  }
  if (help) {
    result.text = help_text(*known, *help == "--help");
    return result;
  }
  Options options;
  const auto app = make_app(options);
  return parse_command(options, *app, arguments);
}

}  // namespace kith::cli
