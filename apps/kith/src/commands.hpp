#pragma once

#include "console.hpp"
#include "options.hpp"

namespace kith::cli {

// One function per command, each in its own file: does it, and returns the exit
// code. What goes wrong is thrown as kith::Error.

int run_validate(const ValidateOptions& options, Console& console);
int run_inspect(const InspectOptions& options, Console& console);
int run_explain(const ExplainOptions& options, Console& console);
int run_init(const InitOptions& options, Console& console);
int run_curriculum(const CurriculumCommandOptions& options, Console& console);
int run_ask(const AskOptions& options, Console& console);
int run_find(const FindOptions& options, Console& console);
int run_teach(const TeachOptions& options, Console& console);
int run_study(const StudyOptions& options, Console& console);
int run_analyze(const AnalyzeOptions& options, Console& console);
int run_report(const ReportCommandOptions& options, Console& console);
int run_fit(const FitCommandOptions& options, Console& console);
int run_doctor(Console& console);
int run_completion(const CompletionOptions& options, Console& console);
int run_version(Console& console);
int run_calibrate(const CalibrateOptions& options, Console& console);
int run_status(const StatusOptions& options, Console& console);
int run_audit(const AuditCommandOptions& options, Console& console);
int run_verify(const VerifyCommandOptions& options, Console& console);
int run_merge(const MergeOptions& options, Console& console);
int run_export(const ExportOptions& options, Console& console);
int run_serve(const ServeOptions& options, Console& console);
int run_session(const SessionOptions& options, Console& console);
int run_power(const PowerCommandOptions& options, Console& console);

}  // namespace kith::cli
