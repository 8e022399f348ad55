#include "telemetry/record/run_inputs.h"

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "scratch_file.h"

using namespace kadans;

namespace {

RunInputs sample() {
  const std::string text = "return 1\n" + std::string(10'000, '-');
  return {.run = {{"scenario", "squat.json"}, {"clock", "virtual"}},
          .program = {{"libm.so.6", "12ab"}},
          .files = {{"behaviors/tulip/squat.lua", content_hash(text), text},
                    {"empty.json", content_hash(""), ""},
                    {"models/mesh.stl", "", std::nullopt}}};
}

RunInputs read_back(const ScratchFile& file) {
  McapReader reader(file.path());
  McapMessage message;
  while (reader.next(message)) {
  }
  return read_inputs(reader, file.path());
}

void write_sample(const ScratchFile& file, const RunInputs& inputs) {
  McapWriter writer;
  REQUIRE(writer.open(file.path()));
  REQUIRE(write_inputs(writer, inputs));
  REQUIRE(writer.close());
}

}  // namespace

TEST_CASE("Inputs come back out of a record as they were, small") {
  const ScratchFile file;
  write_sample(file, sample());
  CHECK(file.bytes().size() < 2500);
  const RunInputs back = read_back(file);
  CHECK(back.fact("scenario") == "squat.json");
  CHECK(back.fact("nothing").empty());
  CHECK(back.program == sample().program);
  REQUIRE(back.files.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(back.files[i].path == sample().files[i].path);
    CHECK(back.files[i].hash == sample().files[i].hash);
    CHECK(back.files[i].text == sample().files[i].text);
  }
}

TEST_CASE("A record that is cut short still has its inputs, one without any has none") {
  const ScratchFile file;
  write_sample(file, sample());
  const std::vector<std::byte> whole = file.bytes();
  file.write(std::span(whole).first(whole.size() - 30));
  CHECK(read_back(file).files.size() == 3);
  write_sample(file, {});
  CHECK(read_back(file).empty());
}

TEST_CASE("Inputs whose text is not what its hash says, or whose path leads out of the project, are refused") {
  const ScratchFile file;
  RunInputs inputs = sample();
  inputs.files[0].hash = content_hash("another");
  write_sample(file, inputs);
  CHECK_THROWS_WITH_AS(read_back(file), doctest::Contains("squat.lua is damaged"), InputError);
  inputs = sample();
  inputs.files[0].path = "behaviors/../../etc/passwd";
  write_sample(file, inputs);
  CHECK_THROWS_WITH_AS(read_back(file), doctest::Contains("is no path inside a project"), InputError);
}
