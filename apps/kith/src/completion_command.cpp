#include <algorithm>

#include "commands.hpp"
#include "completion.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/study/study_file.hpp"

namespace kith::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// In single quotes, which neither shell looks into.
std::string single_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c;
    }
  }
  return result + "'";
}

// Words to offer where a file may also be named.
std::vector<std::string> words_of(const OptionDescription& option) {
  if (!option.choices.empty()) return option.choices;
  std::vector<std::string> words;
  if (option.value == "DOMAIN") {
    for (const auto& domain : built_in_domains()) words.emplace_back(domain.name);
  }
  if (option.value == "STUDY") {
    for (const auto& study : built_in_studies()) words.emplace_back(study.name);
  }
  return words;
}

bool takes_files(const OptionDescription& option) {
  return option.value == "DOMAIN" || option.value == "STUDY" || option.value == "FILE" || option.value == "DIR";
}

std::string bash_reply(const OptionDescription& option) {
  std::string reply;
  const auto words = words_of(option);
  if (!words.empty()) reply += "COMPREPLY+=($(compgen -W " + single_quoted(joined(words)) + " -- \"$current\")); ";
  if (takes_files(option)) {
    reply += std::string{"compopt -o filenames; COMPREPLY+=($(compgen "} + (option.value == "DIR" ? "-d" : "-f") +
             " -- \"$current\")); ";
  }
  return reply;
}

}  // namespace

std::string bash_completion(const std::vector<CommandDescription>& commands) {
  std::string names, cases;
  for (const auto& command : commands) {
    std::string options, values, positional;
    for (const auto& option : command.options) {
      if (option.positional) {
        positional += bash_reply(option);
        continue;
      }
      options += (options.empty() ? "" : " ") + joined(option.names);
      if (option.value.empty()) continue;
      std::string pattern;
      for (const auto& name : option.names) pattern += (pattern.empty() ? "" : "|") + name;
      values += "        " + pattern + ") " + bash_reply(option) + "return ;;\n";
    }
    names += (names.empty() ? "" : " ") + command.name;
    cases += "    " + command.name + ")\n";
    if (!values.empty()) cases += "      case $previous in\n" + values + "      esac\n";
    cases += "      if [[ $current == -* ]]; then COMPREPLY=($(compgen -W " + single_quoted(options) +
             " -- \"$current\")); return; fi\n      " + (positional.empty() ? ":" : positional) + " ;;\n";
  }
  return "# bash completion for kith\n"
         "_kith() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  COMPREPLY=()\n"
         "  if ((COMP_CWORD == 1)); then\n"
         "    COMPREPLY=($(compgen -W " +
         single_quoted(names + " help --help --version") +
         " -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  case ${COMP_WORDS[1]} in\n"
         "    help) COMPREPLY=($(compgen -W " +
         single_quoted(names) + " -- \"$current\")) ;;\n" + cases +
         "  esac\n"
         "}\n"
         "complete -F _kith kith\n";
}

std::string zsh_completion(const std::vector<CommandDescription>& commands) {
  const auto plain = [](std::string text) {  // brackets and colons structure a specification
    for (char& c : text) {
      if (c == '[' || c == ']' || c == ':' || c == '\'') c = ' ';
    }
    return text;
  };
  const auto action = [](const OptionDescription& option) -> std::string {
    const std::string files = option.value == "DIR" ? "_files -/" : takes_files(option) ? "_files" : "";
    const auto words = joined(words_of(option));
    if (files.empty()) return words.empty() ? " " : "(" + words + ")";
    return words.empty() ? files : "{compadd -- " + words + "; " + files + "}";
  };
  std::string list, cases;
  for (const auto& command : commands) {
    list += "    " + single_quoted(command.name + ":" + plain(command.summary)) + "\n";
    cases += "    " + command.name + ")\n      _arguments";
    for (const auto& option : command.options) {
      if (option.positional) {
        cases +=
            " \\\n        " + single_quoted((option.many ? "*:" : ":") + plain(option.value) + ":" + action(option));
        continue;
      }
      for (const auto& name : option.names) {
        auto spec = name + "[" + plain(option.description) + "]";
        if (!option.value.empty()) spec += ":" + plain(option.value) + ":" + action(option);
        cases += " \\\n        " + single_quoted(spec);
      }
    }
    cases += " ;;\n";
  }
  return "#compdef kith\n"
         "_kith() {\n"
         "  local -a commands=(\n" +
         list +
         "  )\n"
         "  if ((CURRENT == 2)); then\n"
         "    _describe command commands\n"
         "    return\n"
         "  fi\n"
         "  local command=$words[2]\n"
         "  shift words\n"
         "  ((CURRENT--))\n"
         "  case $command in\n" +
         cases +
         "  esac\n"
         "}\n"
         "if [[ $funcstack[1] == _kith ]]; then _kith \"$@\"; else compdef _kith kith; fi\n";
}

std::string fish_completion(const std::vector<CommandDescription>& commands) {
  std::string text = "# fish completion for kith\ncomplete -c kith -f\n";
  for (const auto& command : commands) {
    text +=
        "complete -c kith -n __fish_use_subcommand -a " + command.name + " -d " + single_quoted(command.summary) + "\n";
    const std::string here = "complete -c kith -n '__fish_seen_subcommand_from " + command.name + "'";
    for (const auto& option : command.options) {
      std::string line = here;
      for (const auto& name : option.names) {
        if (option.positional) continue;
        line += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      const auto words = words_of(option);
      if (!option.value.empty() && !option.positional) line += takes_files(option) ? " -rF" : " -x";
      if (option.positional && takes_files(option)) line += " -F";
      if (!words.empty()) line += " -a " + single_quoted(joined(words));
      text += line + " -d " + single_quoted(option.description) + "\n";
    }
  }
  return text;
}

int run_completion(const CompletionOptions& options, Console& console) {
  const auto commands = describe_commands();
  if (options.shell == "bash") console.print(bash_completion(commands));
  if (options.shell == "zsh") console.print(zsh_completion(commands));
  if (options.shell == "fish") console.print(fish_completion(commands));
  return 0;
}

}  // namespace kith::cli
