#include "help.hpp"

#include <algorithm>
#include <map>

#include "kind_lists.hpp"
#include "kith/present/wrapped.hpp"

namespace kith::cli {
namespace {

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() + 2 > width) return text + "\n" + std::string(width, ' ');
  text.resize(width, ' ');
  return text;
}

std::string left_column(const OptionDescription& option) {
  std::string text = "  " + joined(option.names, ", ");
  if (!option.positional && !option.value.empty()) text += " " + option.value;
  return text;
}

std::string right_column(const OptionDescription& option, std::size_t width, bool full) {
  const std::string next = "\n" + std::string(width, ' ');
  const auto lines = [&](const std::string& words) {
    return wrapped(words, kTextWidth - width, std::string(width, ' '));
  };
  std::string text = lines(option.description);
  if (!option.choices.empty()) text += next + lines("one of: " + joined(option.choices, ", "));
  if (!full) return text;
  std::vector<std::string> facts;
  if (!option.default_text.empty()) facts.push_back("default: " + option.default_text);
  if (!option.environment.empty()) facts.push_back("environment: " + option.environment);
  if (!facts.empty()) text += next + lines("(" + joined(facts, "; ") + ")");
  return text;
}

std::string usage_line(const CommandDescription& command) {
  std::string text = "usage: kith " + command.name + " [OPTIONS]";
  for (const auto& option : command.options) {
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

const std::vector<std::string>& examples_of(const std::string& command) {
  static const std::map<std::string, std::vector<std::string>> kExamples{
      {"validate", {"kith validate my-domain.toml my-study.toml", "kith validate --strict --json domains/*.toml"}},
      {"inspect", {"kith inspect item-delivery", "kith inspect item-delivery --show policy,demos --mdp 63"}},
      {"init", {"kith init my-robot", "kith init my-robot --template blank"}},
      {"curriculum", {"kith curriculum item-delivery", "kith curriculum my-domain.toml -o lesson.html"}},
      {"ask",
       {"kith ask item-delivery 'when does it recharge?'",
        "kith ask item-delivery 'why up, not left, at (4,3) carrying the parcel?'"}},
      {"find",
       {"kith find item-delivery", "kith find item-delivery '(-1,0,2)' --test",
        "kith find item-delivery '(-1,0,2)' -o world.toml"}},
      {"teach", {"kith teach item-delivery --group NNP --strategy joint", "kith teach --from results/paper --team 17"}},
      {"study",
       {"kith study studies/paper.toml -o results/paper",
        "kith study quick -o results/quick --set teacher.process_noise=0.5"}},
      {"analyze", {"kith analyze results/paper", "kith analyze people.csv --model 'knowledge ~ strategy*composition'"}},
      {"report", {"kith report results/paper", "kith report results/paper -o paper.html"}},
      {"fit",
       {"kith fit results/paper -o fit.json", "kith fit trials.csv --types 2", "kith fit results/paper --method grid"}},
      {"explain", {"kith explain E0207", "kith explain strategies", "kith explain learners --json"}},
      {"doctor", {"kith doctor", "kith doctor --json"}},
      {"completion",
       {"kith completion bash > ~/.local/share/bash-completion/completions/kith", "source <(kith completion bash)"}},
      {"calibrate",
       {"kith calibrate paper-uncalibrated --targets targets.toml -o mine.toml",
        "kith calibrate paper --targets studies/paper-targets.toml --quick"}},
      {"power",
       {"kith power paper --effect 'knowledge: joint - common = 0.05' --target 0.9",
        "kith power studies/paper.toml --findings studies/paper-targets.toml"}},
      {"status", {"kith status results/paper", "watch -n 5 kith status results/paper"}},
      {"audit",
       {"kith audit results/paper", "kith audit results/paper --team 17",
        "kith audit results/live --room r3 -o audit.html"}},
      {"verify", {"kith verify results/paper", "kith verify results/paper --sample 0.1"}},
      {"export",
       {"kith export item-delivery --mdp 63 --to gym-json -o delivery.json",
        "kith export my-domain.toml --to prism -o models/my-domain"}},
      {"merge", {"kith merge results/part-* -o results/paper", "kith merge part-1 part-2 part-3 -o paper --json"}},
      {"serve",
       {"kith serve --demo", "kith serve study.toml -o results/live", "kith serve study.toml --rehearse 20 --for 60"}},
      {"session",
       {"kith session list results/live", "kith session export results/live -o tables",
        "kith session replay results/live --room r3"}},
      {"version", {"kith --version", "kith --version --json"}}};
  return kExamples.at(command);
}

std::string help_text(const std::vector<CommandDescription>& commands, bool full) {
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
        "Nothing else in the\n"
        "environment changes what a command does.\n\n";
    text += kExitCodes;
  }
  return text + "\n`kith COMMAND -h` for a command's options, `kith COMMAND --help` for details.\n";
}

namespace {

bool takes_keys(const CommandDescription& command) {
  return std::any_of(command.options.begin(), command.options.end(),
                     [](const auto& option) { return option.names.front() == "--set"; });
}

}  // namespace

std::string help_text(const CommandDescription& command, bool full) {
  constexpr std::size_t kFullWidth = 28;
  std::string text = usage_line(command) + "\n" + wrapped(command.summary + ".", kTextWidth) + "\n\nexamples:\n";
  for (const auto& example : command.examples) text += "  " + example + "\n";
  text += "\n";
  bool any_positional = false;
  for (const bool positional : {true, false}) {
    if (!positional) text += any_positional ? "\noptions:\n" : "options:\n";
    for (const auto& option : command.options) {
      if (option.positional != positional) continue;
      if (positional && !any_positional) text += "arguments:\n";
      any_positional = any_positional || positional;
      text += padded(left_column(option), kFullWidth) + right_column(option, kFullWidth, full) + "\n";
    }
  }
  if (full && takes_keys(command)) text += "\n" + keys_text();
  if (full) text += std::string{"\n"} + kExitCodes;
  return text;
}

}  // namespace kith::cli
