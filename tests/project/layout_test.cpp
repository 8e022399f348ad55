// The tree against the rules of docs/architecture.md, and the rules against examples that break them.
#include "layout.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>

namespace fs = std::filesystem;
using namespace kadans::layout;

namespace {

const fs::path root = KADANS_SOURCE_DIR;
const std::vector<std::string> abc{"exchange", "signal", "model", "plant", "engine", "config", "script", "app"};

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (fs::recursive_directory_iterator it(folder), end; it != end; ++it) {
    if (it->path().filename() == "node_modules") it.disable_recursion_pending();
    if (it->is_regular_file()) files.push_back(it->path());
  }
  std::ranges::sort(files);
  return files;
}

bool is_code(const fs::path& file) { return file.extension() == ".h" || file.extension() == ".cpp"; }

// package-lock.json is what npm writes; tables of numbers and whatever holds a NUL are data.
bool is_written_by_hand(const fs::path& file, const std::string& text) {
  return file.filename() != "package-lock.json" && file.extension() != ".csv" && text.find('\0') == std::string::npos;
}

std::vector<std::string> layers() { return read_layers(read(root / "src/CMakeLists.txt")); }

void report(const Findings& findings) {
  for (const std::string& finding : findings) FAIL_CHECK(finding);
}

}  // namespace

TEST_CASE("no file of a layer includes a layer below it or a library fenced off from it") {
  std::size_t checked = 0;
  for (const fs::path& folder : {root / "src", root / "include/kadans"}) {
    for (const fs::path& file : files_below(folder)) {
      if (!is_code(file)) continue;
      report(check_includes(fs::relative(file, folder).generic_string(), read(file), layers()));
      ++checked;
    }
  }
  CHECK(checked > 20);
}

TEST_CASE("what is installed includes nothing that is not") {
  std::size_t checked = 0;
  for (const fs::path& file : files_below(root / "include/kadans")) {
    report(check_public(fs::relative(file, root / "include").generic_string(), read(file)));
    ++checked;
  }
  CHECK(checked > 20);
  CHECK(check_public("kadans/a.h", "#include <vector>\n#include \"kadans/b.h\"\n").empty());
  CHECK(check_public("kadans/a.h", "\n#include \"engine/b.h\"\n") ==
        Findings{"kadans/a.h:2: includes engine/b.h, which is not installed"});
}

TEST_CASE("a plug-in includes what is installed, what lies beside it and what is made of its messages, alone") {
  std::size_t checked = 0;
  for (const fs::path& file : files_below(root / "plugins")) {
    if (!is_code(file)) continue;
    for (const std::string& finding : check_public(fs::relative(file, root).generic_string(), read(file))) {
      const auto begin = finding.find("includes ") + 9;
      fs::path beside = file.parent_path() / finding.substr(begin, finding.find(',') - begin);
      if (!fs::exists(beside) && !fs::exists(beside.replace_extension(".idl"))) FAIL_CHECK(finding);
    }
    ++checked;
  }
  CHECK(checked > 10);
  const fs::path rules = root / "plugins/unitree/CMakeLists.txt";
  CHECK(read(rules).find("src/") == std::string::npos);
}

TEST_CASE("football includes what is installed and its own headers alone, and nothing includes football") {
  std::size_t checked = 0;
  for (const fs::path& file : files_below(root / "src/football")) {
    if (!is_code(file)) continue;
    for (const std::string& finding : check_public(fs::relative(file, root).generic_string(), read(file))) {
      const auto begin = finding.find("includes ") + 9;
      const std::string header = finding.substr(begin, finding.find(',') - begin);
      if (!fs::exists(file.parent_path() / header) && !header.starts_with("football/")) FAIL_CHECK(finding);
    }
    ++checked;
  }
  CHECK(checked > 5);
  for (const char* folder : {"src", "include", "plugins", "tests"}) {
    for (const fs::path& file : files_below(root / folder)) {
      const std::string path = fs::relative(file, root).generic_string();
      const bool own =
          path.starts_with("src/football/") || path.starts_with("tests/football/") || path == "tests/fuzz/football.cpp";
      if (!own && is_code(file) &&
          read(file).find("#include \"football"
                          "/") != std::string::npos)
        FAIL_CHECK(path);
    }
  }
}

TEST_CASE("no folder has more than 25 files") {
  std::map<fs::path, std::size_t> count;
  for (const char* folder : {"src", "include", "plugins", "tests"}) {
    for (const fs::path& file : files_below(root / folder)) {
      const fs::path below = fs::relative(file.parent_path(), root);
      if (!below.generic_string().starts_with("tests/fuzz/corpus")) ++count[below];  // inputs, not files to read
    }
  }
  for (const auto& folder : count) {
    CAPTURE(folder.first.string());
    CHECK(folder.second <= 25);
  }
}

TEST_CASE("no layer's CMakeLists.txt links a layer below it") {
  std::size_t checked = 0;
  for (const fs::path& file : files_below(root / "src")) {
    if (file.filename() != "CMakeLists.txt" || file == root / "src/CMakeLists.txt") continue;
    report(check_links(fs::relative(file, root / "src").generic_string(), read(file), layers()));
    ++checked;
  }
  CHECK(checked >= 2);
}

TEST_CASE("no file is longer than 400 lines, and no source of src than 700") {
  std::size_t checked = 0;
  for (const char* folder : {"src", "include", "plugins", "tests", "behaviors", "scripts", "cmake"}) {
    for (const fs::path& file : files_below(root / folder)) {
      const std::string text = read(file);
      if (is_written_by_hand(file, text)) report(check_length(fs::relative(file, root).generic_string(), text));
      ++checked;
    }
  }
  CHECK(checked > 50);
}

TEST_CASE("the name of every file and folder says what is in it") {
  for (const char* folder :
       {"src", "include", "plugins", "tests", "behaviors", "scripts", "cmake", "config", "models", "docs"}) {
    for (const fs::path& file : files_below(root / folder))
      report(check_name(fs::relative(file, root).generic_string()));
  }
}

TEST_CASE("results are written where it is told when they were not, and JSON takes foreign bytes") {
  for (const fs::path& folder : {root / "src", root / "include/kadans"}) {
    for (const fs::path& file : files_below(folder)) {
      if (is_code(file)) report(check_writing(fs::relative(file, folder).generic_string(), read(file)));
    }
  }
  CHECK(check_writing("app/x.cpp", "  std::ofstream out(file);\n").size() == 1);
  CHECK(check_writing("app/x.cpp", "  FILE* f = std::fopen(name, \"wb\");\n  std::fopen(name, \"rb\");\n").size() == 1);
  CHECK(check_writing("app/x.cpp", "  puts(json.dump());\n  flight.dump();\n") ==
        Findings{"app/x.cpp:1: dumps JSON that may hold foreign bytes: json_text takes them"});
  CHECK(check_writing("app/x.cpp", "  json.dump(2);\n").size() == 1);
  CHECK(check_writing("app/x.cpp", "  const auto json = nlohmann::json::parse(text);\n").size() == 1);
}

TEST_CASE("no type is defined in two files") {
  std::map<std::string, std::string> where;
  for (const fs::path& folder : {root / "src", root / "include/kadans"}) {
    for (const fs::path& file : files_below(folder)) {
      if (!is_code(file) || file.filename() == "ros2_bridge_missing.cpp") continue;  // built in place of another
      for (const std::string& type : types_defined_in(read(file))) {
        const auto [known, first] = where.emplace(type, file.string());
        if (!first) FAIL_CHECK(type, " is defined in ", known->second, " and in ", file.string());
      }
    }
  }
  CHECK(where.size() > 300);
  CHECK(types_defined_in(
            "namespace kadans {\nstruct A {\n};\nclass B;\nclass C final : public A {\n};\nstruct C::F {\n};\n"
            "namespace {\nstruct D {};\n}  // namespace\nenum class E : int { f };\n}  // namespace kadans\n") ==
        std::vector<std::string>{"kadans::A", "kadans::C", "kadans::C::F", "kadans::E"});
}

TEST_CASE("a word of docs/architecture.md stands for one idea in the names of types") {
  for (const fs::path& folder : {root / "src", root / "include/kadans"}) {
    for (const fs::path& file : files_below(folder)) {
      if (is_code(file)) report(check_words(fs::relative(file, folder).generic_string(), read(file)));
    }
  }
  const std::string live = "namespace kadans {\nclass LiveThing {\n};\n}\n";
  CHECK(check_words("remote/page/a.h", live).empty());
  CHECK(check_words("app/run/a.h", live) ==
        Findings{"app/run/a.h: kadans::LiveThing: 'Live' is the server for viewers (docs/architecture.md, words)"});
  CHECK(check_words("app/a.h", "namespace kadans {\nstruct CtlPlace {\n};\nstruct TextPlace {\n};\n}\n").size() == 1);
  const auto wrong = [](const char* path, const std::string& type) {
    return check_words(path, "namespace kadans {\nstruct " + type + " {\n};\n}\n").size() == 1;
  };
  CHECK(wrong("remote/a.h", "TuningStep"));
  CHECK(wrong("app/a.h", "PictureOrder"));
  CHECK_FALSE(wrong("remote/order/a.h", "OrderInfo"));
  CHECK_FALSE(wrong("telemetry/record/a.h", "Recorder"));
  CHECK(wrong("app/run/a.h", "RunRequest"));
  CHECK_FALSE(wrong("remote/order/a.h", "OrderRequest"));
  CHECK(wrong("remote/ros2/a.h", "TextCommands"));
  CHECK_FALSE(wrong("app/command_line.h", "CommandInfo"));
  CHECK(wrong("telemetry/reading/a.h", "LogCut"));
}

TEST_CASE("no test has a name that CTest would tear apart") {
  for (const fs::path& file : files_below(root / "tests")) {
    if (file.extension() == ".cpp") report(check_test_names(fs::relative(file, root).generic_string(), read(file)));
  }
  CHECK(check_test_names("a.cpp",
                         "TEST_CASE"
                         "(\"one; two\")")
            .size() == 1);
  CHECK(check_test_names("a.cpp",
                         "TEST_CASE"
                         "(\"one, two\")")
            .empty());
}

TEST_CASE("every file of tests is compiled: the CMakeLists.txt of its folder, or of one above it, names it") {
  const auto named = [](const fs::path& file) {
    for (fs::path folder = file.parent_path(); folder != root; folder = folder.parent_path()) {
      if (!fs::exists(folder / "CMakeLists.txt")) continue;
      std::string words = read(folder / "CMakeLists.txt");
      std::ranges::replace_if(
          words, [](char c) { return c == '\n' || c == '(' || c == ')'; }, ' ');
      if ((" " + words).find(" " + fs::relative(file, folder).generic_string() + " ") != std::string::npos) return true;
    }
    return false;
  };
  CHECK(named(root / "tests/project/layout_test.cpp"));
  CHECK_FALSE(named(root / "tests/project/lay_test.cpp"));
  for (const fs::path& file : files_below(root / "tests")) {
    if (file.filename().string().ends_with("_test.cpp")) CHECK_MESSAGE(named(file), file);
  }
}

TEST_CASE("docs/architecture.md lists the layers in the order in which they are built") {
  CHECK(layers().size() >= 16);
  CHECK(read_table_layers(read(root / "docs/architecture.md")) == layers());
}

TEST_CASE("docs/architecture.md says of each folder what is in it") {
  const std::string text = read(root / "docs/architecture.md");
  for (const auto& found : fs::recursive_directory_iterator(root / "src")) {
    const std::string folder = fs::relative(found.path(), root / "src").generic_string();
    if (!found.is_directory() || folder.find('/') == std::string::npos) continue;
    CHECK_MESSAGE(text.find("\n| " + folder + " | ") != std::string::npos, folder);
  }
}

TEST_CASE("the checker reads the layers from CMake and from a table") {
  CHECK(read_layers("# order\nset(layers exchange signal\n           model)\n") ==
        std::vector<std::string>{"exchange", "signal", "model"});
  CHECK(read_layers("nothing").empty());
  CHECK(read_table_layers("| word | meaning |\n|---|---|\n| plant | what is controlled |\n\n"
                          "| layer | what |\n|---|---|\n| signal | frames |\n| exchange | queues |\n\n| app | x |\n") ==
        std::vector<std::string>{"signal", "exchange"});
}

TEST_CASE("the checker accepts includes of the own layer, of layers above and of what is open to all") {
  CHECK(check_includes("plant/bullet/world.cpp",
                       "#include \"kadans/plant/plant.h\"\n#include \"kadans/model/urdf.h\"\n#include \"world.h\"\n"
                       "#include <vector>\n#include <Eigen/Core>\n#include <btBulletDynamicsCommon.h>\n",
                       abc)
            .empty());
  CHECK(check_includes("script/state.cpp", "#include <lua.hpp>\n#include <lauxlib.h>\n", abc).empty());
  CHECK(check_includes("config/reader.cpp", "#include <nlohmann/json.hpp>\n", abc).empty());
  CHECK(
      check_includes("model/mass.cpp", "// #include \"kadans/app/main.h\"\n#include <BulletInverseDynamics/x.h>\n", abc)
          .empty());
}

TEST_CASE("the checker finds an include of a layer below, with its line") {
  const Findings findings =
      check_includes("signal/fault.cpp", "#include <array>\n#include \"kadans/plant/plant.h\"\n", abc);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0] == "signal/fault.cpp:2: signal includes plant/plant.h, but plant stands below signal");
  CHECK(check_includes("engine/tick.h", "  #  include  <kadans/script/state.h>\n", abc).size() == 1);
}

TEST_CASE("the checker finds a library outside its fence") {
  CHECK(check_includes("engine/tick.cpp", "#include <lua.hpp>\n", abc).size() == 1);
  CHECK(check_includes("app/main.cpp", "#include <lauxlib.h>\n", abc).size() == 1);
  CHECK(check_includes("plant/ideal.cpp", "#include <btBulletDynamicsCommon.h>\n", abc).size() == 1);
  CHECK(check_includes("engine/tick.cpp", "#include <BulletDynamics/Featherstone/btMultiBody.h>\n", abc).size() == 1);
  CHECK(check_includes("script/state.cpp", "#include <nlohmann/json.hpp>\n", abc).size() == 1);
  CHECK(check_includes("control/arm.cpp", "#include <kdl/tree.hpp>\n", abc).size() == 1);
  CHECK(check_includes("engine/behavior_log.h", "#include <spdlog/logger.h>\n", abc).size() == 1);
}

TEST_CASE("the checker finds files and headers of no layer and paths that climb") {
  CHECK(check_includes("tools/x.cpp", "", abc).size() == 1);
  CHECK(check_includes("app/main.cpp", "#include \"kadans/tools/x.h\"\n", abc).size() == 1);
  CHECK(check_includes("app/main.cpp", "#include \"../signal/table.h\"\n", abc).size() == 1);
}

TEST_CASE("the checker finds a link downwards, and only that") {
  CHECK(check_links("plant/CMakeLists.txt",
                    "kadans_layer(plant SOURCES a.cpp\n  LINKS kadans_model)  # not kadans_app\n", abc)
            .empty());
  CHECK(check_links("plant/bullet/CMakeLists.txt", "kadans_layer(plant/bullet SOURCES a.cpp LINKS kadans_plant)\n", abc)
            .empty());
  const Findings findings = check_links("plant/CMakeLists.txt", "kadans_layer(plant\n  LINKS kadans_engine)\n", abc);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0] == "plant/CMakeLists.txt:2: plant links engine, which stands below it");
  CHECK(check_links("signal/CMakeLists.txt", "target_link_libraries(x kadans::script)\n", abc).size() == 1);
  CHECK(check_links("signal/CMakeLists.txt", "LINKS kadans_plant_bullet\n", abc).size() == 1);
}

TEST_CASE("the checker finds a file that is too long") {
  CHECK(check_length("a.h", std::string(400, '\n')).empty());
  CHECK(check_length("a.h", std::string(401, '\n')) == Findings{"a.h: has 401 lines; 400 is the most"});
  CHECK(check_length("src/a.h", std::string(401, '\n')).size() == 1);
  CHECK(check_length("tests/a.cpp", std::string(401, '\n')).size() == 1);
  CHECK(check_length("src/a.cpp", std::string(700, '\n')).empty());
  CHECK(check_length("src/a.cpp", std::string(701, '\n')) == Findings{"src/a.cpp: has 701 lines; 700 is the most"});
}

TEST_CASE("the checker finds names that say nothing") {
  CHECK(check_name("src/engine/tick/control_engine.cpp").empty());
  CHECK(check_name("tests/signal/community_test.cpp").empty());
  for (const char* path : {"src/utils/a.h", "src/engine/math_utils.h", "src/common/a.h", "src/helpers.cpp",
                           "tests/misc/a.cpp", "src/engine/tick-manager.h"})
    CHECK_MESSAGE(check_name(path).size() == 1, path);
}
