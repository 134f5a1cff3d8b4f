// What is wrong with layers, images, occupancy grids, rasters and listed worlds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "layered_domains.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using testing::layered::all_of;
using testing::layered::domain_text;
using testing::layered::files_with;
using testing::layered::kLegend;
using testing::layered::kYaml;
using testing::layered::read;

struct LayerCase {
  std::string name;
  std::string map;
  std::string when = "leave:smoke";
  std::string expected = "";  // the first error: "E0265 FILE LINE:COLUMN"
  std::string hint = "";
  std::map<std::string, std::string> files = {};
  std::string more = "";
};
std::ostream& operator<<(std::ostream& out, const LayerCase& c) { return out << c.name; }

std::vector<LayerCase> layer_cases() {
  const std::string rows = "rows = [\"S.mG\"]\n" + kLegend;  // lines 4 to 11
  const std::string wide = "rows = [\"S.mG\", \"....\"]\n" + kLegend;
  const std::string layer = "[[map.layer]]\n";    // line 12
  const std::string raster = "[[map.raster]]\n";  // line 12
  const std::string grid = "occupancy = \"floor.yaml\"\n" + kLegend + "[[map.layer]]\nrows = [\"S mG\"]\n";
  const std::string toml = " layers.toml ";
  const auto yaml = [](const std::string& text) { return std::map<std::string, std::string>{{"floor.yaml", text}}; };
  const auto pgm = [](const std::string& text) { return std::map<std::string, std::string>{{"floor.pgm", text}}; };
  const auto edited = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string image = wide + layer + "image = \"zones.pgm\"\n";  // grey on line 14
  const std::string kBox = "\"b\" = { item = \"box\", carried = true }\n";
  return {
      {"no_drawing", rows + layer + "at = [1, 1]\n", "", "E0109 layers.toml 12:1", "image ="},
      {"two_drawings", "image = \"zones.pgm\"\n" + rows, "", "E0265 layers.toml 3:1", "keep one"},
      {"at_one_number", rows + layer + "rows = [\"m\"]\nat = [1]\n", "", "E0265 layers.toml 14:6", "at = [3, 2]"},
      {"off_the_map", rows + layer + "rows = [\"mm\"]\nat = [4, 1]\n", "", "E0265 layers.toml 13:8", "at = ["},
      {"layer_key", rows + layer + "rows = [\"m\"]\nopt = true\n", "", "E0107 layers.toml 14:1", "did you mean"},
      {"layer_symbol", rows + layer + "rows = [\"?\"]\n", "", "E0203 layers.toml 13:10", "declared"},
      {"optional_twice", rows + layer + "rows = [\"r\"]\noptional = \"a\"\n", "", "E0213 layers.toml 13:10", "one of"},
      {"optional_number", rows + layer + "rows = [\"m\"]\noptional = 3\n", "", "E0108 layers.toml 14:12"},
      {"optional_name", rows + layer + "rows = [\"m\"]\noptional = \"a b\"\n", "", "E0225 layers.toml 14:12", "use"},
      {"goal_in_wall", "rows = [\"S.#G\"]\n" + kLegend + layer + "rows = [\"  G\"]\n", "", "E0270 layers.toml 13:12",
       "free cell"},
      {"start_on_wall", rows + layer + "rows = [\"#\"]\noptional = \"a\"\n", "", "E0209 layers.toml 13:10"},
      {"second_start", rows + layer + "rows = [\" S\"]\n", "", "E0208 layers.toml 13:11"},
      {"start_in_some", "rows = [\"..mG\"]\n" + kLegend + layer + "rows = [\"S\"]\noptional = \"a\"\n", "",
       "E0206 layers.toml 13:10", "world start"},
      {"two_stations",
       "rows = [\"SAmG\"]\n" + kLegend + "\"A\" = { station = \"a\" }\n\"B\" = { station = \"b\" }\n" + layer +
           "rows = [\" B\"]\n",
       "", "E0270 layers.toml 15:11", "another cell"},
      {"two_destinations",
       "rows = [\"SAmG\"]\n" + kLegend +
           "\"a\" = { item = \"a\" }\n\"b\" = { item = \"b\" }\n\"A\" = { destination = \"a\" }\n"
           "\"B\" = { destination = \"b\" }\n" +
           layer + "rows = [\"aB\", \"  \"]\n",
       "", "E0265 layers.toml 17:8"},
      {"item_on_two_cells",
       "rows = [\"S.mG\"]\n" + kLegend + "\"a\" = { item = \"a\" }\n" + layer + "rows = [\" a\"]\noptional = \"x\"\n" +
           layer + "rows = [\"a\"]\noptional = \"y\"\n",
       "", "E0211 layers.toml 4:8", "in world"},
      {"carried_nothing", rows + "\"b\" = { terrain = \"x\", carried = true }\n", "", "E0272 layers.toml 12:34",
       "item ="},
      {"carried_elsewhere", "rows = [\"SbmG\"]\n" + kLegend + kBox, "", "E0272 layers.toml 4:8", "carried = true"},
      {"carried_twice",
       "rows = [\"S.mG\"]\n" + kLegend + kBox + "\"c\" = { item = \"cup\", carried = true }\n" + layer +
           "rows = [\"b\"]\n" + layer + "rows = [\"c\"]\n",
       "", "E0272 layers.toml 4:8", "one at a time"},
      {"absent_but_there", "absent = [\"smoke\"]\n" + rows, "", "E0274 layers.toml 4:11", "'absent'"},
      {"not_absent", "absent = [\"board\"]\n" + rows, "carrying:bored", "E0216 layers.toml 15:18"},
      // images
      {"image_outside", wide + layer + "image = \"../zones.pgm\"\ngrey = {}\n", "", "E0232 layers.toml 13:9",
       "relative"},
      {"image_ending", wide + layer + "image = \"zones.png\"\ngrey = {}\n", "", "E0232 layers.toml 13:9", ".pgm"},
      {"image_missing", wide + layer + "image = \"none.pgm\"\ngrey = {}\n", "", "E0233 layers.toml 13:9",
       "expected at"},
      {"grey_missing", image, "", "E0109 layers.toml 12:1"},
      {"grey_key", image + "grey = { x = \"m\" }\n", "", "E0269 layers.toml 14:10", "GREY"},
      {"grey_too_large", image + "grey = { 300 = \"m\" }\n", "", "E0269 layers.toml 14:10", "128 ="},
      {"grey_symbol", image + "grey = { 64 = \"z\" }\n", "", "E0269 layers.toml 14:15", "declared"},
      {"grey_unlisted", image + "grey = { 64 = \"m\" }\n", "", "E0269 layers.toml 14:8", "add 128"},
      {"pixels", "pixels_per_cell = 0\n" + rows, "", "E0110 layers.toml 4:19"},
      {"pgm_kind", grid, "", "E0266 floor.pgm 1:1", "PGM", pgm("P6 1 1 255 xxx")},
      {"pgm_number", grid, "", "E0266 floor.pgm 1:6", "8 bits", pgm("P2 4 x 255\n")},
      {"pgm_short", grid, "", "E0266 floor.pgm 2:1", "not complete", pgm("P2 4 2 255\n")},
      {"pgm_bytes", grid, "", "E0266 floor.pgm 1:1", "not complete", pgm("P5 4 2 255\nabc")},
      {"pgm_more_bytes", grid, "", "E0266 floor.pgm 1:1", "one image", pgm("P5 1 1 255\nabc")},
      {"pgm_more_numbers", grid, "", "E0266 floor.pgm 1:14", "one image", pgm("P2 1 1 255 0 P2")},
      {"pgm_deep", grid, "", "E0266 floor.pgm 1:8", "8 bits", pgm("P2 4 2 65535\n1")},
      {"pgm_bright", grid, "", "E0266 floor.pgm 1:11", "PGM", pgm("P2 1 1 10 11")},
      {"pgm_large", grid, "", "E0267 floor.pgm 1:1", "crop", pgm("P2 100000 100000 255\n")},
      {"pgm_empty", grid, "", "E0267 floor.pgm 1:1", "crop", pgm("P2 0 3 255\n")},
      {"yaml_syntax", grid, "", "E0268 floor.yaml 2:1", "expected", yaml("image: [x\n")},
      {"yaml_empty", grid, "", "E0268 floor.yaml 1:1", "map_server", yaml("")},
      {"yaml_nested", grid, "", "E0268 floor.yaml 1:8", "map_server", yaml("image: { a: b }\n")},
      {"yaml_alias", grid, "", "E0268 floor.yaml 1:8", "map_server", yaml("image: *a\n")},
      {"yaml_twice", grid, "", "E0268 floor.yaml 7:1", "remove", yaml(kYaml + "image: x.pgm\n")},
      {"yaml_missing", grid, "", "E0268 floor.yaml 1:1", "map_server", yaml(edited(kYaml, "negate: 0\n", ""))},
      {"yaml_negate", grid, "", "E0268 floor.yaml 4:9", "black", yaml(edited(kYaml, "negate: 0", "negate: 2"))},
      {"yaml_number", grid, "", "E0268 floor.yaml 5:18", "map_server", yaml(edited(kYaml, "0.65", "half"))},
      {"yaml_range", grid, "", "E0268 floor.yaml 5:18", "probability", yaml(edited(kYaml, "0.65", "65"))},
      {"yaml_order", grid, "", "E0268 floor.yaml 6:14", "0.196", yaml(edited(kYaml, "0.196", "0.9"))},
      {"yaml_resolution", grid, "", "E0268 floor.yaml 2:13", "metres", yaml(edited(kYaml, "0.05", "0"))},
      {"yaml_list", grid, "", "E0268 floor.yaml 4:9", "", yaml(edited(kYaml, "negate: 0", "negate: [0]"))},
      {"yaml_mode", grid, "", "E0268 floor.yaml 7:7", "raw", yaml(kYaml + "mode: raw\n")},
      {"yaml_key", grid, "", "W0209 floor.yaml 7:1", "did you mean", yaml(kYaml + "negat: 0\n")},
      {"yaml_absolute", grid, "", "E0268 floor.yaml 1:8", "beside", yaml(edited(kYaml, "floor.pgm", "/floor.pgm"))},
      {"yaml_home", grid, "", "E0268 floor.yaml 1:8", "beside", yaml(edited(kYaml, "floor.pgm", "~/floor.pgm"))},
      {"yaml_url", grid, "", "E0268 floor.yaml 1:8", "beside", yaml(edited(kYaml, "floor.pgm", "file:///floor.pgm"))},
      {"yaml_unexplored", grid, "", "W0208 floor.yaml 6:14", "0.196", yaml(edited(kYaml, "0.196", "0.25"))},
      {"yaml_image", grid, "", "E0232 layers.toml 4:13", ".pgm", yaml(edited(kYaml, "floor.pgm", "floor.png"))},
      {"yaml_ending", "occupancy = \"floor.pgm\"\n" + kLegend, "", "E0232 layers.toml 4:13", ".yaml"},
      {"unknown_word", "unknown = \"lava\"\n" + grid, "", "E0112 layers.toml 4:11"},
      // rasters
      {"raster_kind", rows + raster + "name = \"a\"\n", "", "E0273 layers.toml 12:1", "write one of"},
      {"raster_kinds", rows + raster + "name = \"a\"\nnear = \"smoke\"\nseen_from = \"smoke\"\nwithin = 1\n", "",
       "E0273 layers.toml 12:1", "write one of"},
      {"raster_name", rows + raster + "name = \"a b\"\nnear = \"smoke\"\nwithin = 1\n", "", "E0225 layers.toml 13:8"},
      {"raster_taken", rows + raster + "name = \"smoke\"\nnear = \"smoke\"\nwithin = 1\n", "",
       "E0214 layers.toml 13:8"},
      {"raster_of", rows + raster + "name = \"a\"\nnear = \"smok\"\nwithin = 1\n", "", "E0273 layers.toml 14:8",
       "'smoke'"},
      {"raster_of_nothing", rows + raster + "name = \"a\"\nnear = []\nwithin = 1\n", "", "E0273 layers.toml 14:8"},
      {"raster_reach", rows + raster + "name = \"a\"\nnear = \"smoke\"\n", "", "E0109 layers.toml 12:1"},
      {"raster_sight", rows + raster + "name = \"a\"\nseen_from = \"smoke\"\nwithin = 65\n", "",
       "E0110 layers.toml 15:10"},
      {"raster_symbol", rows + raster + "name = \"a\"\nnear = \"smoke\"\nwithin = 1\nsymbol = \"m\"\n", "",
       "E0273 layers.toml 16:10", "not in [map.legend]"},
      {"raster_robot", rows + raster + "name = \"a\"\nnear = \"smoke\"\nwithin = 1\nsymbol = \"@\"\n", "",
       "E0204 layers.toml 16:10"},
      {"raster_image", rows + raster + "name = \"a\"\nimage = \"zones.pgm\"\n", "", "E0265 layers.toml 14:9",
       "one pixel"},
      {"raster_times", rows, "action", "E0216 layers.toml 15:9", "[[map.raster]]", {}, "times = \"heat\"\n"},
      {"raster_zero", rows + raster + "name = \"a\"\nnear = \"rubble\"\nwithin = 1\n", "", "W0206 layers.toml 13:8",
       "where the things are"},
      // worlds
      {"worlds_none", rows, "", "E0271 layers.toml 21:9", "present", {}, "[family]\nworld = []\n"},
      {"worlds_unknown",
       rows,
       "",
       "E0271 layers.toml 21:12",
       "as optional",
       {},
       "[[family.world]]\npresent = [\"fire\"]\n"},
      {"worlds_twice",
       rows,
       "",
       "E0271 layers.toml 22:1",
       "remove",
       {},
       "[[family.world]]\npresent = []\n[[family.world]]\npresent = []\n"},
      {"worlds_drawn",
       rows,
       "",
       "E0271 layers.toml 21:10",
       "remove",
       {},
       "[family]\nworlds = 2\n[[family.world]]\npresent = []\n"},
      {"worlds_present", rows, "", "E0109 layers.toml 20:1", "", {}, "[[family.world]]\nname = \"a\"\n"},
  };
}

DomainReading read_case(const LayerCase& c) {
  const bool at_end = c.more.starts_with("[");
  const std::string when = c.when.empty() ? "leave:smoke" : c.when;
  return read(domain_text(c.map, when, at_end ? "" : c.more) + (at_end ? c.more : ""), files_with(c.files));
}

class LayerError : public ::testing::TestWithParam<LayerCase> {};

TEST_P(LayerError, IsReportedAtItsPlaceWithAHint) {
  const LayerCase& c = GetParam();
  const auto reading = read_case(c);
  const bool of_warning = c.expected.starts_with("W");
  const Diagnostic* found = nullptr;
  for (const Diagnostic& d : reading.diagnostics) {
    const bool is_it = of_warning ? d.id == c.expected.substr(0, 5) : d.severity == Severity::kError;
    if (found == nullptr && is_it) found = &d;
  }
  ASSERT_NE(found, nullptr) << all_of(reading);
  EXPECT_EQ(found->id + " " + found->file + " " + std::to_string(found->line) + ":" + std::to_string(found->column),
            c.expected)
      << all_of(reading);
  EXPECT_THAT(found->hint, HasSubstr(c.hint));
  EXPECT_EQ(reading.domain.has_value(), of_warning) << all_of(reading);
}

INSTANTIATE_TEST_SUITE_P(All, LayerError, ::testing::ValuesIn(layer_cases()),
                         [](const auto& c) { return c.param.name; });

TEST(LayerErrors, ShowNoBytesOfBinaryImages) {
  const auto reading = read(domain_text("occupancy = \"floor.yaml\"\n" + kLegend, "leave:smoke"),
                            files_with({{"floor.pgm", "P5 \x01\xFF\n"}}));
  ASSERT_FALSE(reading.diagnostics.empty());
  EXPECT_EQ(reading.diagnostics.front().source_line, "");
}

}  // namespace
}  // namespace kith
