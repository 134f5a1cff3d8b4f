#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "help.hpp"
#include "kith/core/diagnostic.hpp"
#include "option_declarations.hpp"
#include "option_values.hpp"

namespace kith::cli {
namespace {

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
