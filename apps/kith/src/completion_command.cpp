#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/study/study_file.hpp"

namespace kith::cli {
namespace {

struct CompletionOptions {
  std::string shell;
};

// Offers the words that an option takes, and files where it may name one.
std::string bash_reply(const OptionDescription& option) {
  auto words = option.choices;
  if (option.value == "DOMAIN") {
    for (const auto& domain : built_in_domains()) words.emplace_back(domain.name);
  } else if (option.value == "STUDY") {
    for (const auto& study : built_in_studies()) words.emplace_back(study.name);
  }
  const bool is_folder = option.value == "DIR";
  std::string reply;
  if (!words.empty()) reply = fmt::format("COMPREPLY+=($(compgen -W '{}' -- \"$current\")); ", fmt::join(words, " "));
  if (is_folder || option.value == "FILE" || option.value == "DOMAIN" || option.value == "STUDY") {
    reply += fmt::format("compopt -o filenames; COMPREPLY+=($(compgen {} -- \"$current\")); ", is_folder ? "-d" : "-f");
  }
  return reply;
}

// The branch of a command: its options, and behind one of them what it takes.
std::string bash_case(const Command& command) {
  OptionList list{command.name};
  (void)command.declare(list);
  list.finish();
  std::vector<std::string> names;
  std::string values, positional;
  for (const auto& option : list.options()) {
    if (option.positional) {
      positional += bash_reply(option);
      continue;
    }
    names.insert(names.end(), option.names.begin(), option.names.end());
    if (option.value.empty()) continue;
    values += fmt::format("        {}) {}return ;;\n", fmt::join(option.names, "|"), bash_reply(option));
  }
  return fmt::format(
      "    {})\n{}      if [[ $current == -* ]]; then COMPREPLY=($(compgen -W '{}' -- \"$current\")); return; fi\n"
      "      {} ;;\n",
      command.name, values.empty() ? "" : "      case $previous in\n" + values + "      esac\n", fmt::join(names, " "),
      positional.empty() ? ":" : positional);
}

int run(const CompletionOptions& /*options*/, Console& console) {
  const auto commands = all_commands();
  std::string names, cases;
  for (const auto& command : commands.all()) {
    names += command.name + " ";
    cases += bash_case(command);
  }
  console.print(fmt::format(R"(# bash completion for kith
_kith() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}}
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{0}help --help --version' -- "$current"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
    help) COMPREPLY=($(compgen -W '{0}' -- "$current")) ;;
{1}  esac
}}
complete -F _kith kith
)",
                            names, cases));
  return 0;
}

}  // namespace

void add_completion(Commands& commands) {
  commands.add<CompletionOptions>(
      "completion", "Print a shell's completion script",
      {"kith completion bash > ~/.local/share/bash-completion/completions/kith", "source <(kith completion bash)"},
      [](OptionList& list, CompletionOptions& options) {
        list.word("shell", options.shell, "SHELL", {"bash"}, "The shell").required();
      },
      run);
}

}  // namespace kith::cli
