#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "command_line.hpp"
#include "commands.hpp"
#include "exit_codes.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"
#include "kith/present/json.hpp"
#include "remedies.hpp"
#include "standard_streams.hpp"

namespace kith::cli {
namespace {

int run(const Options& options, Console& console) {
  switch (options.command) {
    case Command::kValidate:
      return run_validate(options.validate, console);
    case Command::kInspect:
      return run_inspect(options.inspect, console);
    case Command::kInit:
      return run_init(options.init, console);
    case Command::kCurriculum:
      return run_curriculum(options.curriculum, console);
    case Command::kAsk:
      return run_ask(options.ask, console);
    case Command::kFind:
      return run_find(options.find, console);
    case Command::kTeach:
      return run_teach(options.teach, console);
    case Command::kStudy:
      return run_study(options.study, console);
    case Command::kAnalyze:
      return run_analyze(options.analyze, console);
    case Command::kReport:
      return run_report(options.report, console);
    case Command::kFit:
      return run_fit(options.fit, console);
    case Command::kDoctor:
      return run_doctor(console);
    case Command::kCompletion:
      return run_completion(options.completion, console);
    case Command::kVersion:
      return run_version(console);
    case Command::kCalibrate:
      return run_calibrate(options.calibrate, console);
    case Command::kStatus:
      return run_status(options.status, console);
    case Command::kAudit:
      return run_audit(options.audit, console);
    case Command::kVerify:
      return run_verify(options.verify, console);
    case Command::kMerge:
      return run_merge(options.merge, console);
    case Command::kExport:
      return run_export(options.export_model, console);
    case Command::kExplain:
      return run_explain(options.explain, console);
    case Command::kServe:
      return run_serve(options.serve, console);
    case Command::kSession:
      return run_session(options.session, console);
    case Command::kPower:
      return run_power(options.power, console);
  }
  return kInternalError;
}

// How errors without a place in a file are named in JSON.
const char* name_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return "usage";
    case ErrorKind::kInvalidInput:
      return "invalid-input";
    case ErrorKind::kInfeasible:
      return "infeasible";
    case ErrorKind::kIo:
      return "io";
    case ErrorKind::kPartial:
      return "partial";
    case ErrorKind::kMismatch:
      return "mismatch";
    case ErrorKind::kBusy:
      return "busy";
  }
  return "internal";
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
  Diagnostic diagnostic;
  diagnostic.id = std::move(id);
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  return diagnostic;
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
  if (!is_known) diagnostics.push_back(diagnostic_of(name_of(unwritable.kind()), unwritable.what()));
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
  return report(console, {diagnostic_of(name_of(ErrorKind::kIo), message)}, exit_code(ErrorKind::kIo));
}

int report(Console& console, const UsageError& error) {
  auto hint = error.hint;
  std::string help{"kith "};
  if (!error.command.empty()) help.append(error.command).append(" ");
  help.append("-h");
  hint += (hint.empty() ? "see `" : " (see `") + help + (hint.empty() ? "`" : "`)");
  return report(console, {diagnostic_of("usage", error.message, hint)}, exit_code(ErrorKind::kUsage));
}

int report(Console& console, const Error& error) {
  auto diagnostics = with_remedies(error.diagnostics());
  if (diagnostics.empty()) diagnostics.push_back(diagnostic_of({}, error.what()));
  for (auto& one : diagnostics) {
    if (one.id.empty()) one.id = name_of(error.kind());
  }
  return report(console, std::move(diagnostics), exit_code(error.kind()));
}

int guarded(const std::vector<std::string>& arguments, Console& console) try {
  const auto command_line = parse_command_line(arguments);
  if (command_line.error) return report(console, *command_line.error);
  if (command_line.text) {
    console.print(*command_line.text);
    return 0;
  }
  console = Console{command_line.options->common};
  return run(*command_line.options, console);
} catch (const Error& error) {
  return report(console, error);
} catch (const BrokenPipe&) {
  return kBrokenPipeCode;
} catch (const std::bad_alloc&) {
  return report_out_of_memory(console);
} catch (const std::filesystem::filesystem_error& error) {
  return report(console, error);
} catch (const std::system_error& error) {
  return report(console, {diagnostic_of(name_of(ErrorKind::kIo), error.what())}, exit_code(ErrorKind::kIo));
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
