// The matcher of the sandbox against LuaJIT's own, and what it refuses.
#include <cstdlib>

#include <doctest/doctest.h>

#include "fuzz/pattern_comparison.h"
#include "kadans/signal/random.h"
#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;
using kadans::fuzz::PatternComparison;

namespace {

constexpr std::string_view letters("aaabbcxX_09 .,<>()[]%^$-+*?\n\t\0\xff", 31);

std::string pick(RandomStream& random, std::initializer_list<const char*> from) {
  return *(from.begin() + random.next() % from.size());
}

// Of few letters, so that much matches, or of all.
std::string letters_of(RandomStream& random, std::size_t most) {
  const std::string_view from = random.next() % 2 == 0 ? std::string_view("aabc(<)> 1") : letters;
  std::string text;
  for (std::size_t left = random.next() % (most + 1); left > 0; --left) text += from[random.next() % from.size()];
  return text;
}

std::string single_item(RandomStream& random) {
  switch (random.next() % 4) {
    case 0:
      return pick(random, {"a", "b", "x", "%%", ".", ".", "\xff"});
    case 1:
      return "%" + std::string(1, "acdglpsuwxzACDGLPSUWXZ.]b"[random.next() % 25]);
    case 2:
      return "[" + pick(random, {"", "^"}) + pick(random, {"ab", "a-c", "%w_", "]a", "^", "a-", "%a-z", "0-9x"}) + "]";
    default:
      return letters_of(random, 2);
  }
}

// A pattern that is mostly right.
std::string pattern(RandomStream& random) {
  std::string text = random.next() % 5 == 0 ? "^" : "";
  for (std::uint64_t items = random.next() % 6; items > 0; --items) {
    switch (random.next() % 8) {
      case 0:
        text += "(" + single_item(random) + pick(random, {"", "*", "-"}) + ")";
        break;
      case 1:
        text += pick(random, {"()", "%b()", "%b<>", "%bab", "%f[%w]", "%f[^a]", "%1", "%2", "(", ")", "%", "$"});
        break;
      default:
        text += single_item(random) + pick(random, {"", "", "*", "+", "-", "?"});
        break;
    }
  }
  return text + (random.next() % 6 == 0 ? "$" : "");
}

std::string random_case(RandomStream& random) {
  std::string text(1, fuzz::functions[random.next() % fuzz::functions.size()]);
  if (random.next() % 3 == 0) text += std::to_string(static_cast<int>(random.next() % 30) - 10);
  const std::string wanted = pattern(random);
  return text + "\n" + wanted.substr(0, wanted.find('\n')) + "\n" +
         pick(random, {"", "x", "%0%0", "<%1>", "%2", "%%", "%", "%a"}) + "\n" + letters_of(random, 40);
}

}  // namespace

TEST_CASE("patterns find, take apart and replace as in LuaJIT itself") {
  const int cases = std::getenv("KADANS_SOAK") != nullptr ? 1'000'000 : 20'000;
  RandomStream random(1, "patterns");
  PatternComparison comparison;
  int ended = 0;
  for (int i = 0; i < cases; ++i) {
    const std::string text = random_case(random);
    if (!comparison.run(text)) continue;
    ++ended;
    if (comparison.sandbox() == comparison.lua()) continue;
    CAPTURE(text);
    REQUIRE(comparison.sandbox() == comparison.lua());
  }
  CHECK(ended > cases * 99 / 100);
}

TEST_CASE("wrong arguments of patterns raise as in LuaJIT itself") {
  PatternComparison comparison;
  for (const char* text : {"f1e300\na\n\na", "f-1e300\na\n\na", "f4294967297\na\n\naba", "f2147483648\na\n\naba",
                           "m0.5\n.\n\nab", "f7\n\n\nabc", "f4\n\n\nabc", "s-1\na\nx\naaa", "s4294967297\na\nx\naaa",
                           "s\n.\n%9\nabc", "c\n(a)(b)\n\nab", "g\n^a\n\n^a^a"}) {
    CAPTURE(std::string(text));
    CHECK(comparison.run(text));
    CHECK(comparison.sandbox() == comparison.lua());
  }
}

TEST_CASE("patterns nest as deep as in LuaJIT itself, and no deeper") {
  PatternComparison comparison;
  for (const int depth : {5, 31, 32, 33, 150, 198, 199, 200, 201, 300}) {
    for (const char* item : {"a?", "a*", "a-", "(a)", "()"}) {
      std::string nested;
      for (int i = 0; i < depth; ++i) nested += item;
      CAPTURE(nested);
      CHECK(comparison.run("f\n" + nested + "\n\n" + std::string(400, 'a')));
      CHECK(comparison.sandbox() == comparison.lua());
    }
  }
}
