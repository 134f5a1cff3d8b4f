// The only file that includes CLI11, which takes long to compile.
#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <map>

#include "help.hpp"
#include "kith/core/diagnostic.hpp"
#include "kith/teaching/strategy.hpp"

namespace kith::cli {
namespace {

std::string variable_of(const std::string& long_name) {
  std::string name = "KITH_";
  for (const char c : long_name)
    name += c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

// Every option can be set in the environment; help and completion are written by us.
void add_common(CLI::App& command, CommonOptions& common) {
  static const std::map<std::string, ColorMode> kColors{
      {"auto", ColorMode::kAuto}, {"always", ColorMode::kAlways}, {"never", ColorMode::kNever}};
  command.set_help_flag();
  command.add_flag("--json", common.json, "Print one JSON document instead of text");
  command.add_option("--color", common.color, "Colours on a terminal")
      ->transform(CLI::CheckedTransformer(kColors))
      ->type_name("WHEN:{auto,always,never}");
  command.add_flag("-q,--quiet", common.quiet, "Only results and errors");
  command.add_flag("-v,--verbose", common.verbosity, "Say more about what is done; twice: even more");
  for (auto* option : command.get_options()) {
    if (!option->get_lnames().empty()) option->envname(variable_of(option->get_lnames().front()));
  }
}

std::string braces(const std::vector<std::string>& words) {
  std::string text = "{";
  for (const auto& word : words) text += (text.size() > 1 ? "," : "") + word;
  return text + "}";
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
  command.add_option("--show", options.inspect.show, "What to show, separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(inspect_parts()))
      ->type_name("PARTS:" + braces(inspect_parts()));
  command.add_option("--mdp", options.inspect.mdp, "Number of the MDP to show (default: the last, with everything)")
      ->type_name("N");
  command.add_flag("--all", options.inspect.all, "Do not cut long lists short");
  add_common(command, options.common);
}

void add_teach(CLI::App& app, Options& options) {
  auto& teach = options.teach;
  std::vector<std::string> names;
  for (const auto& entry : strategies()) names.emplace_back(entry.name);
  auto& command = *app.add_subcommand("teach", "Teach one simulated team and print a transcript");
  command.add_option("domain", teach.domain, "Built-in domain or file")->type_name("DOMAIN");
  auto* group =
      command.add_option("--group", teach.group, "The members' learner types, one letter each")->type_name("LETTERS");
  auto* strategy = command.add_option("--strategy", teach.strategy, "Whose belief the lessons are chosen for")
                       ->capture_default_str()
                       ->check(CLI::IsMember(names))
                       ->type_name("NAME:" + braces(names));
  auto* seed =
      command.add_option("--seed", teach.seed, "Root of all random streams")->capture_default_str()->type_name("N");
  auto* study = command.add_option("--study", teach.study, "Built-in study or file with the learner types")
                    ->capture_default_str()
                    ->type_name("STUDY");
  auto* set = command.add_option("--set", teach.set, "Set a key of the study (may be repeated)")
                  ->allow_extra_args(false)
                  ->type_name("KEY=VALUE");
  auto* from = command.add_option("--from", teach.from, "Replay a team of this run folder")->type_name("DIR");
  auto* team = command.add_option("--team", teach.team, "Number of the team, as in teams.csv")
                   ->check(CLI::PositiveNumber)
                   ->type_name("N");
  from->needs(team);
  team->needs(from);
  for (auto* other : {group, strategy, seed, study, set}) from->excludes(other);
  add_common(command, options.common);
}

void add_study(CLI::App& app, Options& options) {
  static const std::map<std::string, ProgressMode> kProgress{{"auto", ProgressMode::kAuto},
                                                             {"bar", ProgressMode::kBar},
                                                             {"json", ProgressMode::kJson},
                                                             {"none", ProgressMode::kNone}};
  auto& study = options.study;
  auto& command = *app.add_subcommand("study", "Simulate all teams of a study and write its tables");
  command.add_option("study", study.study, "Built-in study or file; '-' is standard input")
      ->required()
      ->type_name("STUDY");
  command.add_option("-o,--out", study.out, "Run folder to make or to bring up to date")->type_name("DIR");
  command.add_option("-j,--threads", study.threads, "Worker threads (default: one per core); never changes a result")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command.add_option("--seed", study.seed, "The same as --set seed=N")->type_name("N");
  command.add_option("--set", study.set, "Set a key of the study (may be repeated)")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command.add_flag("--dry-run", study.dry_run, "Say what would be run, and run nothing");
  command.add_flag("--yes", study.yes, "Replace the results of a different study in the run folder");
  command.add_option("--progress", study.progress, "How to show progress, on stderr")
      ->transform(CLI::CheckedTransformer(kProgress))
      ->type_name("HOW:{auto,bar,json,none}");
  add_common(command, options.common);
}

void add_others(CLI::App& app, Options& options) {
  auto& doctor = *app.add_subcommand("doctor", "Check that this machine runs kith as it should");
  add_common(doctor, options.common);
  auto& completion = *app.add_subcommand("completion", "Print a shell's completion script");
  completion.add_option("shell", options.completion.shell, "The shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}))
      ->type_name("SHELL:{bash,zsh,fish}");
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

const std::map<std::string, std::vector<std::string>>& examples() {
  static const std::map<std::string, std::vector<std::string>> kExamples{
      {"validate", {"kith validate my-domain.toml my-study.toml", "kith validate --strict --json domains/*.toml"}},
      {"inspect", {"kith inspect item-delivery", "kith inspect item-delivery --show policy,demos --mdp 63"}},
      {"teach", {"kith teach item-delivery --group NNP --strategy joint", "kith teach --from results/paper --team 17"}},
      {"study",
       {"kith study studies/paper.toml -o results/paper",
        "kith study quick -o results/quick --set replicates=10 --set teacher.process_noise=0.5"}},
      {"doctor", {"kith doctor", "kith doctor --json"}},
      {"completion",
       {"kith completion bash > ~/.local/share/bash-completion/completions/kith", "source <(kith completion zsh)"}},
      {"version", {"kith --version", "kith --version --json"}}};
  return kExamples;
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
  CommandDescription result{command.get_name(), command.get_description(), examples().at(command.get_name()), {}};
  for (const auto* option : command.get_options()) result.options.push_back(describe(*option));
  result.options.push_back({{"-h"}, "", "Short help with examples", "", {}, "", false, false, false});
  result.options.push_back({{"--help"}, "", "Full help", "", {}, "", false, false, false});
  return result;
}

// The mend for what CLI11 did not understand.
UsageError explain(const CLI::App& command, const std::string& what) {
  UsageError error{what, "", command.get_name()};
  const auto left = command.remaining();
  if (left.empty()) return error;
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
    result.error = explain(command, error.what());
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
