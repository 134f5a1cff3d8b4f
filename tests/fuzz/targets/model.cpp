// Explicit models and grids. The first byte says which file the rest is, or that it is the domain file that names
// the others; these are sound. A domain or errors, never both; a domain can be asked about, taught and judged.
#include <array>

#include "../fuzzing.hpp"
#include "../whole_robot.hpp"
#include "kith/domains/domain_file.hpp"

using namespace kith;

namespace {

const std::string kHead = "schema = \"kith.domain/1\"\nid = \"m\"\n[mdp]\ndiscount = 0.5\n[model]\n";
const std::string kTail =
    "[[feature]]\nname = \"f\"\n[[feature]]\nname = \"g\"\n[reward]\nweights = { f = -1, g = 2 }\n";
const std::string kCsv = kHead + "format = \"csv\"\nstates = \"a.csv\"\ntransitions = \"b.csv\"\n" + kTail;

const std::string kGrid =
    "schema = \"kith.domain/1\"\nid = \"m\"\n[map]\noccupancy = \"m.yaml\"\nunknown = \"floor\"\n[map.legend]\n"
    "S = { start = true }\nG = { goal = true }\nz = { terrain = \"z\" }\n[[map.layer]]\nrows = [\"S G\"]\n"
    "[[map.layer]]\nimage = \"m.pgm\"\ngrey = { 0 = \"z\", 1 = \"z\", 2 = \"z\" }\n[[map.raster]]\nname = \"r\"\n"
    "image = \"m.pgm\"\nlevels = 3\n[[feature]]\nname = \"f\"\nwhen = \"enter:r\"\ntimes = \"r\"\n[[feature]]\n"
    "name = \"g\"\nwhen = \"action\"\n[reward]\nweights = { f = -1, g = -2 }\n";

constexpr const char* kDomainFile = "m.toml";

struct Layout {
  const std::string* domain;  // null: it is what is fuzzed
  const char* fuzzed;         // the name of the file that the bytes are
};
const std::array<Layout, 5>& layouts() {
  static const std::array<Layout, 5> kLayouts{
      {{&kCsv, "a.csv"}, {&kCsv, "b.csv"}, {nullptr, kDomainFile}, {&kGrid, "m.pgm"}, {&kGrid, "m.yaml"}}};
  return kLayouts;
}

DomainFiles files_with(const char* name, std::string_view text) {
  DomainFiles files;
  files.known = {
      {name, std::string{text}},
      {"a.csv", "state,terminal,x\na,false,1\nb,false,2\nc,true,3\n"},
      {"b.csv", "state,action,next,probability,f,g\na,go,b,1,0,1\nb,go,c,0.5,1,0\nb,go,a,0.5,0,0\n"},
      {"m.yaml",
       "image: m.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.9\nfree_thresh: 0.2\n"},
      {"m.pgm", "P2\n3 2\n3\n3 1 3\n0 3 2\n"}};
  return files;
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.words = "model", .head_bytes = 1};

fuzzing::Outcome fuzzing::run(std::string_view input) {
  if (input.empty()) return Outcome::kMalformed;
  const auto& layout = layouts()[static_cast<unsigned char>(input.front()) % layouts().size()];
  const auto text = input.substr(1);
  const std::string domain{layout.domain == nullptr ? text : std::string_view{*layout.domain}};
  const auto reading = parse_domain(domain, kDomainFile, {.max_states = 2'000}, files_with(layout.fuzzed, text));
  fuzzing::require(reading.domain.has_value() != has_errors(reading.diagnostics), "a domain, or errors");
  const auto outcome = fuzzing::require_good(reading.diagnostics, text, layout.fuzzed);
  if (reading.domain) fuzzing::WholeRobot::use(*reading.domain);
  return outcome;
}
