#include "signal/number_text.h"

#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/signal/shell_word.h"

using namespace kadans;

TEST_CASE("A number is the whole of a text, or there is none") {
  CHECK(number_of<double>("2.5") == 2.5);
  CHECK(number_of<int>("-3") == -3);
  CHECK(number_of<std::uint64_t>("00000000000000ff", 16) == 255U);
  for (const char* text : {"", " 1", "1 ", "1x", "+1", "0x1"}) CHECK_FALSE(number_of<double>(text));
  CHECK_FALSE(number_of<std::uint64_t>("-1"));
  CHECK_FALSE(number_of<std::uint8_t>("256"));
}

TEST_CASE("A hash has sixteen digits") {
  CHECK(hash_text(0) == "0000000000000000");
  CHECK(hash_text(0xfedcba9876543210U) == "fedcba9876543210");
  CHECK(number_of<std::uint64_t>(hash_text(0x123456789abcdefU), 16) == 0x123456789abcdefU);
}

TEST_CASE("Printed text longer than its room is cut, not lost") {
  CHECK(printed("%d of %s", 2, "three") == "2 of three");
  CHECK(printed("%s", std::string(600, 'x').c_str()).size() == 511);
}

TEST_CASE("number_of takes whole texts that are finite numbers, and nothing else") {
  CHECK(number_of<double>("-1.5e3") == -1500);
  for (const char* text : {"", "nan", "-nan", "inf", "-inf", "infinity", "1e999", "1 ", " 1", "1x", "0x10", "+1"}) {
    CAPTURE(text);
    CHECK_FALSE(number_of<double>(text));
  }
  CHECK_FALSE(number_of<unsigned>("-1"));
}

TEST_CASE("a list is told with what stands between its items, also around an empty one") {
  const std::vector<std::string> words{"", "left", "right"};
  CHECK(listed(words) == ", left, right");
  CHECK(listed(
            words, [](const std::string& word) { return "'" + word + "'"; }, ", ", " or ") == "'', 'left' or 'right'");
  CHECK(listed(std::vector<std::string>{}).empty());
}

TEST_CASE("a word of a command is quoted when the shell would take it for something else") {
  CHECK(shell_word("config/scenarios/squat.json") == "config/scenarios/squat.json");
  CHECK(shell_word("my squat.json") == "'my squat.json'");
  CHECK(shell_word("it's") == "'it'\\''s'");
  CHECK(shell_word("") == "''");
  for (const char* word : {"a*", "$HOME", "a;b", "a&b", "`x`", "~", "a|b", "(x)", "#1", "a\nb"})
    CHECK(shell_word(word).front() == '\'');
}

TEST_CASE("the words of a quoted line are read back") {
  std::string line = "kadans";
  const std::vector<std::string> words{"kadans", "a b", "it's", "", "x*=1", "\\", "plain"};
  for (std::size_t i = 1; i < words.size(); ++i) line += " " + shell_word(words[i]);
  CHECK(shell_words(line) == words);
}
