#include "serve_rehearsal.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>

#include "exit_codes.hpp"
#include "interrupt.hpp"
#include "kith/core/text.hpp"
#include "kith/explain/json.hpp"
#include "kith/explain/words.hpp"
#include "kith/live/world_json.hpp"
#include "kith/store/event_file.hpp"

namespace kith::cli {
namespace {

// The robot's own path from a state as a page would show it, as numbers of actions.
std::optional<AnswerPath> robots_path(const LiveStudy& study, const std::string& world, int start) {
  const auto number = world_of_key(study, world);
  if (!number || start < 0) return std::nullopt;
  const auto& mdp = study.atlas->domain().mdp(*number);
  const StateIndex state{static_cast<std::size_t>(start)};
  if (state.value() >= mdp.num_states()) return std::nullopt;
  const auto path = expected_path(*study.atlas, study.atlas->index({*number, state}));
  AnswerPath answer{{}, path.repeats_from.has_value()};
  for (const auto action : path.actions) answer.actions.push_back(static_cast<int>(action.value()));
  return answer;
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// What the process occupies now; 0 if the system does not tell.
double resident_megabytes() {
  std::ifstream file{"/proc/self/statm"};
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

// The median of what was measured in a quarter of the time, 1 to 4; nothing for a few measurements.
std::optional<double> median_in_quarter(const std::vector<double>& values, std::size_t quarter) {
  constexpr std::size_t kFewest = 8;
  if (values.size() < kFewest) return std::nullopt;
  const auto at = [&](std::size_t q) { return values.begin() + static_cast<std::ptrdiff_t>(values.size() * q / 4); };
  std::vector<double> part{at(quarter - 1), at(quarter)};
  const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
  std::nth_element(part.begin(), middle, part.end());
  return *middle;
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json{}; }

Json to_json(const LatencySummary& times) {
  return {{"count", times.count},
          {"p50_ms", times.p50},
          {"p95_ms", times.p95},
          {"p99_ms", times.p99},
          {"max_ms", times.max}};
}

Json document_of(const RehearsalResult& result, const RehearsalRecord& record, const StoredAnswers& stored) {
  Json document{
      {"schema", "kith.rehearsal/1"},
      {"groups", result.groups},
      {"people", result.people},
      {"seconds", result.seconds},
      {"answers", {{"acknowledged", result.answers.size()}, {"lost", stored.lost}, {"stored_twice", stored.twice}}},
      {"messages", {{"acknowledged", result.messages}, {"refused", result.refused}, {"unanswered", result.unanswered}}},
      {"refusals", Json::object()},
      {"acknowledgement", to_json(result.acknowledgement)},
      {"next_lesson", to_json(result.next_lesson)},
      {"reconnect", to_json(result.reconnect)},
      {"reconnects", result.reconnects},
      {"connections_lost", result.connections_lost},
      {"finished", result.num_finished()},
      {"stages", Json::object()},
      {"restarts", record.restarted_after ? 1 : 0},
      {"restart_seconds", record.restarted_after ? Json(record.restart_seconds) : Json{}},
      {"peak_memory_mb", peak_megabytes()},
      {"memory_mb",
       {{"second_quarter", or_null(median_in_quarter(record.memory_mb, 2))},
        {"last_quarter", or_null(median_in_quarter(record.memory_mb, 4))}}}};
  document["problems"] = result.problems;
  for (const auto& [reason, count] : result.refusals) document["refusals"][reason] = count;
  for (const auto& [stage, count] : result.stages) document["stages"][stage] = count;
  return document;
}

std::vector<std::string> row_of(const std::string& name, const LatencySummary& times) {
  if (times.count == 0) return {name, "0", "-", "-", "-", "-"};
  return {name,
          std::to_string(times.count),
          fmt::format("{:.1f}", times.p50),
          fmt::format("{:.1f}", times.p95),
          fmt::format("{:.1f}", times.p99),
          fmt::format("{:.1f}", times.max)};
}

std::string counts_text(const auto& counts) {
  const auto text = joined(counts, ", ", [](const auto& one) { return fmt::format("{} {}", one.first, one.second); });
  return text.empty() ? "none" : text;
}

std::string memory_text(const RehearsalRecord& record) {
  auto text = fmt::format("{:.0f} MB at most, the simulated people included", peak_megabytes());
  const auto early = median_in_quarter(record.memory_mb, 2);
  const auto late = median_in_quarter(record.memory_mb, 4);
  if (early && late) {
    text += fmt::format("; median {:.0f} MB in the second quarter of the time, {:.0f} MB in the last", *early, *late);
  }
  return text;
}

std::string restart_text(const RehearsalRecord& record) {
  if (!record.restarted_after) return "not restarted";
  return fmt::format("restarted after {:.0f} s; accepted connections again {:.1f} s later", *record.restarted_after,
                     record.restart_seconds);
}

}  // namespace

RehearsalOptions rehearsal_options(const ServeOptions& options, std::shared_ptr<const LiveStudy> study,
                                   std::uint16_t port, LiveService::StartLinks links, std::function<void()> restart,
                                   RehearsalRecord& record) {
  RehearsalOptions rehearsal;
  rehearsal.port = port;
  rehearsal.facilitator = std::move(links.facilitator);
  rehearsal.observer = std::move(links.observer);
  rehearsal.groups = options.rehearse;
  rehearsal.duration = std::chrono::milliseconds{static_cast<std::int64_t>(1000.0 * options.for_seconds)};
  rehearsal.answer_every = std::chrono::milliseconds{static_cast<std::int64_t>(1000.0 * options.answer_every)};
  rehearsal.reconnects = options.reconnects;
  // Groups that learn are done after a minute or two. New ones follow them, but most of the time would be spent
  // joining.
  if (options.for_seconds > 0.0) rehearsal.right = 0.0;
  rehearsal.right_path = [study = std::move(study)](const std::string& world, int start) {
    return robots_path(*study, world, start);
  };
  const auto restart_after = options.restart_after;
  rehearsal.on_tick = [restart_after, restart = std::move(restart), &record](std::chrono::milliseconds elapsed) {
    const auto seconds = std::chrono::duration<double>(elapsed).count();
    if (static_cast<double>(record.memory_mb.size()) <= seconds) record.memory_mb.push_back(resident_megabytes());
    if (restart_after > 0.0 && !record.restarted_after && seconds >= restart_after) {
      const auto start = std::chrono::steady_clock::now();
      record.restarted_after = seconds;
      restart();
      record.restart_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    return stop_signal() == 0;
  };
  return rehearsal;
}

StoredAnswers look_up(const std::vector<std::string>& answers, const std::filesystem::path& folder) {
  std::unordered_map<std::string, std::size_t> times;
  auto file = EventFile::read(folder);
  file.for_each_event([&](const StoredEvent& event) {
    if (event.message && event.type == "answered") ++times[*event.message];
  });
  StoredAnswers stored;
  for (const auto& id : answers) {
    const auto found = times.find(id);
    const auto count = found == times.end() ? 0 : found->second;
    stored.lost += count == 0;
    stored.twice += count > 1;
  }
  return stored;
}

int report_rehearsal(const ServeOptions& options, const RehearsalResult& result, const RehearsalRecord& record,
                     const StoredAnswers& stored, Console& console) {
  const bool restarts = options.restart_after > 0.0;
  if (console.json()) {
    console.print_json(document_of(result, record, stored));
  } else {
    std::string text = fmt::format(
        "{} with {}, {:.0f} s\n", counted(result.groups, "group"),
        result.people == 1 ? "1 simulated person" : fmt::format("{} simulated people", result.people), result.seconds);
    text += fmt::format("answers    {} acknowledged, {} lost, {} stored twice\n", result.answers.size(), stored.lost,
                        stored.twice);
    text += fmt::format("messages   {} acknowledged, {} refused, {} unanswered\n", result.messages, result.refused,
                        result.unanswered);
    if (result.refused > 0) text += fmt::format("refused    {}\n", counts_text(result.refusals));
    text += fmt::format("reconnects {}; connections lost otherwise: {}\n", result.reconnects, result.connections_lost);
    text += fmt::format("ended at   {}\n", counts_text(result.stages));
    if (restarts) text += fmt::format("server     {}\n", restart_text(record));
    text += fmt::format("memory     {}\n\n", memory_text(record));
    TextTable table{"lrrrrr"};
    table.add({"milliseconds", "count", "median", "95 %", "99 %", "max"});
    table.add(row_of("acknowledgement", result.acknowledgement));
    table.add(row_of("next lesson", result.next_lesson));
    table.add(row_of("view after reconnecting", result.reconnect));
    console.print(text + table.text(console));
  }
  if (stored.lost + stored.twice > 0) return exit_code(ErrorKind::kMismatch);
  if (stop_signal() != 0) return 128 + stop_signal();
  const auto unfinished = result.people - result.num_finished();
  const bool is_restarted = !restarts || record.restarted_after;
  if (unfinished > 0) {
    console.warning(
        fmt::format("{} of {} simulated people did not get to an end; where they are, the line 'ended at' "
                    "says",
                    unfinished, result.people));
  }
  for (const auto& problem : result.problems) console.warning("whoever looked was told: " + problem);
  if (!is_restarted) {
    console.warning(
        fmt::format("the rehearsal was over after {:.1f} s, before --restart-after {:g}: no restart was "
                    "rehearsed; restart earlier, or let people take longer with --answer-every",
                    result.seconds, options.restart_after));
  }
  return unfinished == 0 && is_restarted ? 0 : exit_code(ErrorKind::kPartial);
}

}  // namespace kith::cli
