#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "command.hpp"
#include "exit_codes.hpp"
#include "help.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/json.hpp"
#include "standard_streams.hpp"

namespace kith::cli {
namespace {

// Remedies as options and commands of this program.
std::string_view words_for(Remedy remedy) {
  switch (remedy) {
    case Remedy::kNone:
      return {};
    case Remedy::kReplaceContents:
      return "choose another folder, or add --yes to replace what is in this one";
    case Remedy::kStartOver:
      return "start the study over with --resume never";
    case Remedy::kAllowStart:
      return "leave out --resume require to start the study from the beginning";
    case Remedy::kRunStudy:
      return "make one with: kith study STUDY -o DIR";
    case Remedy::kRunShard:
      return "make one with: kith study STUDY --shard I/N -o DIR";
    case Remedy::kMergeShards:
      return "merge all shards with: kith merge DIR... -o DIR";
    case Remedy::kMergePart:
      return "merge what is available with --allow-partial";
    case Remedy::kAnalyseTable:
      return "analyse a table of your own with: kith analyze FILE --model ...";
    case Remedy::kShowMap:
      return "see the map with everything on it: kith inspect DOMAIN";
    case Remedy::kShowStates:
      return "see the names of all states: kith inspect DOMAIN --show policy --all";
    case Remedy::kListConstraints:
      return "choose one that this lists: kith find DOMAIN";
  }
  return {};
}

// The diagnostics with their remedies added to the hints.
std::vector<Diagnostic> with_remedies(std::vector<Diagnostic> diagnostics) {
  for (auto& diagnostic : diagnostics) {
    const auto words = words_for(diagnostic.remedy);
    if (!words.empty()) diagnostic.hint.append(diagnostic.hint.empty() ? "" : "; or ").append(words);
  }
  return diagnostics;
}

// "E1201" is explained on a page, "usage" is for scripts.
bool is_documented(std::string_view id) { return id.size() == 5 && (id[0] == 'E' || id[0] == 'W'); }

// Without a file or a line, the program itself is the place.
void show(Console& console, std::vector<Diagnostic> diagnostics) {
  for (auto& diagnostic : diagnostics) {
    if (!diagnostic.file.empty()) continue;
    diagnostic.file = "kith";
    if (!is_documented(diagnostic.id)) diagnostic.id.clear();
  }
  console.show(diagnostics);
}

Diagnostic diagnostic_of(std::string id, std::string message, std::string hint = {}) {
  return {.id = std::move(id), .message = std::move(message), .hint = std::move(hint)};
}

// Where the document cannot be written, its errors are shown as text, and then the reason: scripts and people both
// learn that there is no document, and why.
int report(Console& console, std::vector<Diagnostic> diagnostics, int code) try {
  if (!console.json()) {
    show(console, std::move(diagnostics));
    return code;
  }
  console.print_json(error_document(diagnostics));
  return code;
} catch (const BrokenPipe&) {
  return kBrokenPipeCode;
} catch (const Error& unwritable) {
  const bool is_known = diagnostics.size() == 1 && diagnostics.front().message == unwritable.what();
  if (!is_known) diagnostics.push_back(diagnostic_of(ending_of(unwritable.kind()).name, unwritable.what()));
  show(console, std::move(diagnostics));
  return exit_code(unwritable.kind());
}

// Takes no memory of its own.
int report_out_of_memory(Console& console) {
  constexpr std::string_view kDocument =
      "{\"schema\": \"kith.error/1\", \"errors\": [{\"id\": \"memory\", \"message\": \"out of memory\", "
      "\"file\": null, \"line\": null, \"column\": null, \"hint\": \"use fewer threads (-j), a smaller domain or fewer "
      "teams, or give the program more memory\"}]}\n";
  write_log(
      "kith: error: out of memory\n"
      "   = help: use fewer threads (-j), a smaller domain or fewer teams, or give the program more memory\n");
  if (console.json()) console.print(kDocument);
  return exit_code(ErrorKind::kIo);
}

int report(Console& console, const std::filesystem::filesystem_error& error) {
  const auto path = error.path1().empty() ? std::string{"a file"} : error.path1().string();
  const auto message = "cannot access " + path + ": " + error.code().message();
  return report(console, {diagnostic_of("io", message)}, exit_code(ErrorKind::kIo));
}

int report(Console& console, const UsageError& error) {
  const auto see = fmt::format("see `kith {}{}-h`", error.command, error.command.empty() ? "" : " ");
  const auto hint = error.hint.empty() ? see : error.hint + " (" + see + ")";
  return report(console, {diagnostic_of("usage", error.message, hint)}, exit_code(ErrorKind::kUsage));
}

int report(Console& console, const Error& error) {
  auto diagnostics = with_remedies(error.diagnostics());
  if (diagnostics.empty()) diagnostics.push_back(diagnostic_of({}, error.what()));
  for (auto& diagnostic : diagnostics) {
    if (diagnostic.id.empty()) diagnostic.id = ending_of(error.kind()).name;
  }
  return report(console, std::move(diagnostics), exit_code(error.kind()));
}

// The first of -h and --help, or nothing.
std::string asked_help(const std::vector<std::string>& arguments) {
  for (const auto& argument : arguments) {
    if (argument == "-h" || argument == "--help") return argument;
    if (argument == "--") break;
  }
  return {};
}

int run(std::vector<std::string> arguments, Console& console) {
  if (!arguments.empty() && arguments.front() == "help") {  // `kith help study` is `kith study --help`
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  const auto all = all_commands();
  const auto& commands = all.all();
  const auto help = asked_help(arguments);
  if (arguments.empty() || arguments.front() == help) {
    console.print(help_text(commands, help == "--help"));
    return 0;
  }
  auto name = arguments.front();
  arguments.erase(arguments.begin());
  if (name == "--version" || name == "-V") name = "version";
  if (name == "curriculum") {
    name = "lesson";
    console.info("'kith curriculum' is called 'kith lesson' now");
  }
  const auto command =
      std::find_if(commands.begin(), commands.end(), [&](const auto& one) { return one.name == name; });
  if (command == commands.end()) {
    std::vector<std::string> names{"--version", "--help", "help"};
    for (const auto& one : commands) names.push_back(one.name);
    const auto nearest = nearest_word(name, names);
    throw UsageError{(name.rfind('-', 0) == 0 ? "unknown option '" : "unknown command '") + name + "'",
                     nearest.empty() ? "" : "did you mean '" + nearest + "'?"};
  }
  OptionList options{name};
  const auto act = command->declare(options);
  options.finish();
  if (!help.empty()) {
    console.print(help_text(*command, options.options(), help == "--help"));
    return 0;
  }
  try {
    options.parse(std::move(arguments));
  } catch (UsageError& error) {
    error.command = name;
    throw;
  }
  console = Console{options.common()};
  return act(console);
}

int guarded(const std::vector<std::string>& arguments, Console& console) try {
  return run(arguments, console);
} catch (const UsageError& error) {
  return report(console, error);
} catch (const Error& error) {
  return report(console, error);
} catch (const BrokenPipe&) {
  return kBrokenPipeCode;
} catch (const std::bad_alloc&) {
  return report_out_of_memory(console);
} catch (const std::filesystem::filesystem_error& error) {
  return report(console, error);
} catch (const std::system_error& error) {
  return report(console, {diagnostic_of("io", error.what())}, exit_code(ErrorKind::kIo));
} catch (const std::exception& error) {
  const std::string message = std::string{"internal error: "} + error.what();
  return report(console, {diagnostic_of("internal", message, "this is a bug in kith; please report it")},
                kInternalError);
}

// Before the command line is understood, all we know is whether "--json" is on it.
CommonOptions first_guess(const std::vector<std::string>& arguments) {
  CommonOptions options;
  for (const auto& argument : arguments) options.json = options.json || argument == "--json";
  return options;
}

}  // namespace
}  // namespace kith::cli

int main(int argc, char** argv) {
  kith::cli::reserve_standard_descriptors();
  kith::cli::ignore_broken_pipes();
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    kith::cli::Console console{kith::cli::first_guess(arguments)};
    return kith::cli::guarded(arguments, console);
  } catch (const kith::cli::BrokenPipe&) {
    return kith::cli::kBrokenPipeCode;
  } catch (...) {
    kith::cli::write_log("kith: error: a failure could not be reported: out of memory, or no output\n");
    return kith::cli::exit_code(kith::ErrorKind::kIo);
  }
}
