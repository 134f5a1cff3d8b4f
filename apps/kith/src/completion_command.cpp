#include "command_line.hpp"
#include "commands.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/study/study_file.hpp"

namespace kith::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// In single quotes, which the shell does not look into.
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

}  // namespace

int run_completion(const CompletionOptions& /*options*/, Console& console) {
  console.print(bash_completion(describe_commands()));
  return 0;
}

}  // namespace kith::cli
