#!/usr/bin/env python3
"""Adds a stage in which people see each other's answers to a copy of the tree, and leaves out one file after the other.

The compilers must accept the whole and say what is missing without any one file, and the map of the project
(docs/architecture.md) must send people to these files and to no others. Run from the root of the repository:

  tests/house/stage.py NODE MODULES COMPILER OPTION...     MODULES: a folder with node_modules
"""
import concurrent.futures
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

MOST = 15
ROOT = pathlib.Path.cwd()
LIVE, WEB = "libs/live/src/", "web/src/"


# What is changed in a file, from its beginning to its end; a pattern is looked for behind the change before.
def after(pattern, text):
    return pattern, lambda line: line + "\n" + text


def before(pattern, text):
    return pattern, lambda line: text + "\n" + line


def instead(old, new):
    return re.escape(old), lambda line: line.replace(old, new)


def behind(pattern):
    return pattern, lambda line: line


FEEDBACK = r"case RoomPhase::kFeedback:"
TEXTS = "\n".join(f'  "{key}": "x",' for key in
                  ("compare.title", "wait.title.comparison", "wait.why.comparison", "wait.next.comparison"))
SCREEN = """import type { JSX } from 'preact';
import { t } from '../../shared/texts';
import { Button, Heading, TimeLeft } from '../parts/ui';
import type { ScreenProps } from '../screen';

export function Compare({ compare, view, connection }: ScreenProps & { compare: { answers: number[][] } }): JSX.Element {
  return (
    <>
      <Heading>{t('compare.title')}</Heading>
      <TimeLeft until={view.limit_ms} />
      <p>{compare.answers.length}</p>
      <Button primary onClick={() => connection.send('compare', {})}>
        {t('common.continue')}
      </Button>
    </>
  );
}
"""

# By file: what complaints say without it, and its part of the stage.
STAGE = {
    "libs/study/include/kith/study/group_options.hpp": ("compare_s", [
        after(r"int64_t discuss_s = 0", "  std::int64_t compare_s = 0;"),
        after(r"array kGroupTimeKeys\{",
              '    GroupTimeKey{.name = "compare_s", .member = &GroupTime::compare_s, .is_always_written = false},'),
        after(r"bool explore = false", "  bool compare = false;"),
        after(r"array kGroupScreenKeys\{", '    GroupScreenKey{"compare", &GroupScreens::compare},')]),
    "libs/live/include/kith/live/room_event.hpp": ("Compared", [
        before(r"^struct Continued", "struct Compared {\n"
               '  static constexpr RoomEventKind kKind{"compared", "compare", kSeat};\n'
               "  static constexpr std::tuple<> kMembers{};\n};\n"),
        instead("std::variant<happening::Joined,", "std::variant<happening::Joined, happening::Compared,")]),
    "libs/live/include/kith/live/room_phase.hpp": ("kComparing", [
        instead("kEnded, kDiscussing", "kEnded, kDiscussing, kComparing"),
        before(FEEDBACK, "    case RoomPhase::kComparing:\n"
               '      return {RoomStage::kRunning, "compare", "comparison", &GroupTime::compare_s, true};')]),
    LIVE + "room_stepper.cpp": ("room_stepper.cpp", [
        behind(r"^bool has_done_phase"),
        before(FEEDBACK, "    case RoomPhase::kComparing:"),
        behind(r"^void RoomStepper::advance"),
        behind(r"case RoomPhase::kTesting:"),
        after(r"if \(!all_done\(\)\) return;", "        if (study_.group().screens.compare) {\n"
              "          begin_phase(RoomPhase::kComparing);\n          break;\n        }"),
        before(FEEDBACK, "      case RoomPhase::kComparing:\n        if (!all_done()) return;\n"
               "        for (auto& seat : state_.seats) seat.has_continued = false;\n"
               "        finish_tests();\n        break;"),
        behind(r"^void RoomStepper::finish_phase"),
        before(FEEDBACK, "    case RoomPhase::kComparing:")]),
    LIVE + "room_decide.cpp": ("Compared", [
        before(r"Decision ask\(OfKind<Continued>\)", "  [[nodiscard]] Decision ask(OfKind<Compared>) const {\n"
               "    if (state_.phase != RoomPhase::kComparing || !seat_.in_period) return not_now();\n"
               "    return seat_.has_continued ? nothing_to_do() : accepted(Compared{});\n  }\n")]),
    LIVE + "room_apply.cpp": ("room_apply.cpp", [
        before(r"void happen\(const Continued&\)",
               "  void happen(const Compared&) { who().has_continued = true; }")]),
    LIVE + "participant_view.cpp": ("participant_view.cpp", [
        behind(r"void add_phase\("),
        before(FEEDBACK, "      case RoomPhase::kComparing:\n        for (const auto& seat : state_.seats) {\n"
               "          for (const auto& path : seat.paths) {\n"
               '            if (path) view["compare"]["answers"].push_back(path->actions);\n          }\n'
               "        }\n        return;")]),
    "libs/store/src/room_history.cpp": ("room_history.cpp", [
        before(r"void note\(const Continued&\)", "  void note(const Compared&) {}")]),
    "libs/service/src/bot_mind.cpp": ("bot_mind.cpp", [
        before(FEEDBACK, "    case RoomPhase::kComparing:\n"
               '      return BotAct{.type = "compare", .body = Json::object(), .key = stage + period, .pace = 0.3};')]),
    WEB + "live/protocol.ts": ("compar", [
        after(r"^  \| 'discuss'", "  | 'compare'"),
        before(r"^  discuss\?:", "  compare?: { answers: number[][] };"),
        instead("'discussion' |", "'discussion' | 'comparison' |"),
        before(r"^  continue: ", "  compare: Record<string, never>;")]),
    WEB + "live/app.tsx": ("app.tsx", [
        before(r"^import \{ Discuss \}", "import { Compare } from './screens/compare';"),
        before(r"^    case 'discuss':", "    case 'compare':\n"
               "      return view.compare ? <Compare {...props} compare={view.compare} /> : null;")]),
    WEB + "live/screens/compare.tsx": ("screens/compare", SCREEN),
    WEB + "facilitator/words.ts": ("words.ts", [
        before(r"^  discuss: \{", "  compare: { doing: 'comparing', phase: 'Comparison', limit: 'comparison' },")]),
    WEB + "shared/texts/en.json": ("comparison", [after(r"^\{", TEXTS)]),
    WEB + "shared/texts/de.json": ("comparison", [after(r"^\{", TEXTS)]),
}


def with_stage(path):
    changes = STAGE[path][1]
    if isinstance(changes, str):
        return changes
    lines, at = (ROOT / path).read_text().split("\n"), 0
    for pattern, change in changes:
        found = [i for i in range(at, len(lines)) if re.search(pattern, lines[i])]
        if not found:
            sys.exit(f"{path} has no line like {pattern} where it is expected: mend tests/house/stage.py")
        at = found[0]
        lines[at] = change(lines[at])
        at += 1
    return "\n".join(lines)


def complaints_without(left_out, node, modules, compiler):
    """What the compilers say of a tree with the stage but for one file, or with all of it."""
    with tempfile.TemporaryDirectory() as folder:
        tree = pathlib.Path(folder)
        layers = ["libs/study/include", "libs/live", "libs/store/src", "libs/store/include", "libs/service/src"]
        for layer in layers if left_out is None or left_out.startswith("libs") else []:
            shutil.copytree(ROOT / layer, tree / layer, ignore=shutil.ignore_patterns("tests"))
        if left_out is None or left_out.startswith("web"):
            shutil.copytree(ROOT / "web/src", tree / "web/src")
            config = (ROOT / "web/tsconfig.json").read_text()
            (tree / "web/tsconfig.json").write_text(config.replace('["src"]', '["src/live", "src/facilitator"]'))
            (tree / "web/node_modules").symlink_to(pathlib.Path(modules).resolve() / "node_modules")
        for path in STAGE:
            if path != left_out and (tree / path).parent.exists():
                (tree / path).write_text(with_stage(path))
        said = ""
        if (tree / "libs").exists():
            sources = [path for path in STAGE if path.endswith(".cpp")]
            if left_out in sources:
                sources = [left_out]  # nothing else can be wrong
            own = [f"-I{tree / layer}" for layer in (*layers, "libs/live/src", "libs/live/include")]
            said += run([compiler[0], "-fsyntax-only", "-fmax-errors=2", "-Werror=switch", *own, *compiler[1:],
                         *(str(tree / path) for path in sources)])
        if (tree / "web").exists():
            tsc = [node, "node_modules/typescript/bin/tsc", "--noEmit", "--preserveSymlinks"]
            said += run([*tsc, "-p", "."], tree / "web")
        return said.replace(str(tree) + "/", "")


def run(command, folder=None):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr if done.returncode != 0 else ""


def problems(node, modules, compiler):
    if len(STAGE) > MOST:
        yield f"a stage takes {len(STAGE)} files, more than {MOST}"
    row = next(line for line in (ROOT / "docs/architecture.md").read_text().split("\n") if line.startswith("| stage of"))
    changed = {pathlib.Path(path).name for path, (_, part) in STAGE.items() if not isinstance(part, str)}
    for name in sorted(set(re.findall(r"`([a-z_]+\.[a-z]+)`", row)) ^ changed):
        yield f"docs/architecture.md, row 'stage of a room', and this stage differ in {name}"
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        said = pool.map(lambda path: complaints_without(path, node, modules, compiler), [None, *STAGE])
        for path, complaints in zip([None, *STAGE], said):
            print(f"without {path}: {complaints.splitlines()[:1]}" if path else "with all files", flush=True)
            if path is None and complaints:
                yield f"the whole does not compile:\n{complaints}"
            elif path is not None and STAGE[path][0] not in complaints:
                yield f"without {path} no complaint says '{STAGE[path][0]}':\n{complaints[:2000]}"


if __name__ == "__main__":
    # The changed headers come first. The compiler knows /usr/include, and is misled if it is told.
    options = [option for option in sys.argv[4:] if option != "-I/usr/include"]
    found = list(problems(sys.argv[1], sys.argv[2], [sys.argv[3], *options]))
    print("\n".join(found) or f"a stage takes {len(STAGE)} files, and without any of them the compilers complain")
    sys.exit(1 if found else 0)
