#include "help.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "kind_lists.hpp"
#include "kith/explain/wrapped.hpp"

namespace kith::cli {
namespace {

std::string padded(std::string text, std::size_t width) {
  if (text.size() + 2 > width) return text + "\n" + std::string(width, ' ');
  text.resize(width, ' ');
  return text;
}

std::string left_column(const OptionDescription& option) {
  std::string text = "  " + fmt::format("{}", fmt::join(option.names, ", "));
  if (!option.positional && !option.value.empty()) text += " " + option.value;
  return text;
}

std::string right_column(const OptionDescription& option, std::size_t width, bool full) {
  const std::string blank(width, ' ');
  const auto lines = [&](const std::string& words) { return wrapped(words, kTextWidth, blank, blank); };
  std::string text = lines(option.description).substr(width);
  if (!option.choices.empty()) text += "\n" + lines(fmt::format("one of: {}", fmt::join(option.choices, ", ")));
  if (!full) return text;
  std::vector<std::string> facts;
  if (!option.default_text.empty()) facts.push_back("default: " + option.default_text);
  if (!option.environment.empty()) facts.push_back("environment: " + option.environment);
  if (!facts.empty()) text += "\n" + lines(fmt::format("({})", fmt::join(facts, "; ")));
  return text;
}

std::string usage_line(const Command& command, const std::vector<OptionDescription>& options) {
  std::string text = "usage: kith " + command.name + " [OPTIONS]";
  for (const auto& option : options) {
    if (!option.positional) continue;
    const std::string name = option.names.front() + (option.many ? "..." : "");
    text += option.required ? " " + name : " [" + name + "]";
  }
  return text + "\n";
}

constexpr const char* kExitCodes =
    "exit codes:\n"
    "  0 success                          5 input or output failed, or out of memory\n"
    "  1 internal error                   6 finished, but some teams failed\n"
    "  2 wrong command line               7 verification mismatch\n"
    "  3 invalid input file               8 another process uses this folder\n"
    "  4 valid, but nothing can be done   130, 143 interrupted; rerun to resume\n";

}  // namespace

std::string help_text(const std::vector<Command>& commands, bool full) {
  std::string text =
      "kith: teach a robot's policy to a group of people by demonstration\n\n"
      "usage: kith COMMAND [OPTIONS] ...\n\ncommands:\n";
  for (const auto& command : commands) text += padded("  " + command.name, 15) + command.summary + "\n";
  text +=
      "\nexamples:\n"
      "  kith study studies/paper.toml -o results/paper\n"
      "  kith teach item-delivery --group NNP --strategy joint\n";
  if (full) {
    text +=
        "\nenvironment: KITH_THREADS=2 is `--threads 2` where that is not given,\n"
        "KITH_MEMORY=8G is the most memory that kith uses, NO_COLOR turns colours off.\n"
        "Nothing else in the environment changes what a command does.\n\n";
    text += kExitCodes;
  }
  return text + "\n`kith COMMAND -h` for a command's options, `kith COMMAND --help` for details.\n";
}

std::string help_text(const Command& command, const std::vector<OptionDescription>& options, bool full) {
  constexpr std::size_t kFullWidth = 28;
  std::string text =
      usage_line(command, options) + "\n" + wrapped(command.summary + ".", kTextWidth) + "\n\nexamples:\n";
  for (const auto& example : command.examples) text += "  " + example + "\n";
  text += "\n";
  bool any_positional = false;
  for (const bool positional : {true, false}) {
    if (!positional) text += any_positional ? "\noptions:\n" : "options:\n";
    for (const auto& option : options) {
      if (option.positional != positional) continue;
      if (positional && !any_positional) text += "arguments:\n";
      any_positional = any_positional || positional;
      text += padded(left_column(option), kFullWidth) + right_column(option, kFullWidth, full) + "\n";
    }
  }
  const auto is_set = [](const auto& option) { return option.names.front() == "--set"; };
  if (full && std::any_of(options.begin(), options.end(), is_set)) text += "\n" + keys_text();
  if (full) text += std::string{"\n"} + kExitCodes;
  return text;
}

}  // namespace kith::cli
