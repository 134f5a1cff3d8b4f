#include "options.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <sstream>

#include "kith/core/error.hpp"
#include "sampling.hpp"

namespace kith::faults {
namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error{ErrorKind::kUsage, message + "\n" + usage()}; }

std::uint64_t number_in(const std::string& text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) refuse("'" + text + "' is no number");
  return number;
}

// kill=100,io=100
std::map<std::string, std::size_t> numbers_of_cases(const std::string& text) {
  std::map<std::string, std::size_t> cases;
  std::istringstream pieces{text};
  for (std::string piece; std::getline(pieces, piece, ',');) {
    const auto at = piece.find('=');
    const auto family = piece.substr(0, at);
    const auto& known = all_families();
    if (at == std::string::npos || std::find(known.begin(), known.end(), family) == known.end()) {
      refuse("'" + piece + "' is not FAMILY=N");
    }
    cases[family] = number_in(piece.substr(at + 1));
  }
  return cases;
}

}  // namespace

std::string usage() {
  std::string families;
  for (const auto& family : all_families()) families += " " + family;
  return "usage: kith_faults --program KITH --shim LIBRARY [OPTIONS]\n"
         "  --cases FAMILY=N,...   how many cases of each family (default: 20 of each):\n"
         "                        " +
         families +
         "\n"
         "  --scenarios A,B,...    only these\n"
         "  --seed N               which cases (default: 1)\n"
         "  --seconds S            begin no case after so many seconds\n"
         "  -j N                   so many at once (default: 1)\n"
         "  --mpirun PATH          try two ranks, too\n"
         "  --case 'WORDS'         replay one case and keep its folder\n"
         "exit codes: 0 all well, 1 something is wrong, 2 wrong command line, 5 no program or no space\n";
}

Options parse_options(int argc, char** argv) {
  Options options;
  for (const auto& family : all_families()) options.cases[family] = 20;
  for (int i = 1; i < argc; ++i) {
    std::string option = argv[i];
    if (option == "-h" || option == "--help") {
      options.help = true;
      return options;
    }
    std::string attached;  // -j2
    if (option.rfind("-j", 0) == 0) {
      attached = option.substr(2);
      option = "-j";
    }
    if (attached.empty() && i + 1 == argc) refuse("'" + option + "' is not known or lacks its value");
    const std::string value = attached.empty() ? argv[++i] : attached;
    if (option == "--program") {
      options.tools.program = std::filesystem::absolute(value);
    } else if (option == "--shim") {
      options.tools.shim = std::filesystem::absolute(value);
    } else if (option == "--mpirun") {
      options.tools.mpirun = value;
    } else if (option == "--cases") {
      options.cases = numbers_of_cases(value);
    } else if (option == "--scenarios") {
      options.scenarios = value;
    } else if (option == "--case") {
      options.only_case = value;
    } else if (option == "--seed") {
      options.seed = number_in(value);
    } else if (option == "--seconds") {
      options.seconds = std::strtod(value.c_str(), nullptr);
    } else if (option == "-j") {
      options.jobs = std::max<std::size_t>(1, number_in(value));
    } else {
      refuse("there is no option " + option);
    }
  }
  if (options.tools.program.empty() || options.tools.shim.empty()) refuse("--program and --shim are needed");
  return options;
}

}  // namespace kith::faults
