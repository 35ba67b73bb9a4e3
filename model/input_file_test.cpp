#include "model/input_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "model/testing/error_of.h"

namespace splatscope {
namespace {

std::string repeated(std::string_view part, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += part;
  return text;
}

std::string toml_error(const std::string& text) {
  return error_of([&] { parse_toml(text, "a.toml"); });
}

TEST(InputFile, NumbersOnALineAreNoPartsOfAKey) {
  EXPECT_EQ(toml_error("x = [" + repeated("0.5, ", 1000) + "0.5]\n"), "no error");
  EXPECT_EQ(toml_error("x = [" + repeated("{ a.b = 0.5, c = \"1.2.3\" }, ", 100) + "]\n"), "no error");
  EXPECT_EQ(toml_error("x = \"" + repeated(".", 1000) + "\"  # " + repeated(".", 1000) + "\n"), "no error");
}

TEST(InputFile, KeysOfTooManyPartsAreRefused) {
  const std::string key = fmt::format("a{}", repeated(".a", 100));
  for (const std::string& text :
       {fmt::format("{} = 1\n", key), fmt::format("[{}]\n", key), fmt::format("[[{}]]\n", key),
        fmt::format("x = {{ y = 0.5, {} = 1 }}\n", key), fmt::format("a{} = 1\n", repeated(".\"b\"", 100))}) {
    EXPECT_EQ(toml_error(fmt::format("\n{}", text)),
              "a.toml:2: a key of too many parts, expected TOML of a table and a key")
        << text;
  }
}

TEST(InputFile, AStringOfSeveralLinesHidesNoKeyAndIsNone) {
  const std::string key = fmt::format("a{}", repeated(".a", 100)), dots = repeated(".", 100);
  for (const char* quotes : {"\"\"\"", "'''"}) {
    EXPECT_EQ(toml_error(fmt::format("x = {0}\n{1}\n{1}{0}\n", quotes, dots)), "no error");
    for (const std::string& text :
         {fmt::format("x = {{ y = {0}a{0}, {1} = 1 }}\n", quotes, key),
          fmt::format("x = {{ y = {0}a{2}{2}{0}, {1} = 1 }}\n", quotes, key, quotes[0]),
          fmt::format("x = {{ y = {0}{0}, {1} = 1 }}\n", quotes, key)}) {
      EXPECT_EQ(toml_error(text), "a.toml:1: a key of too many parts, expected TOML of a table and a key")
          << text;
    }
    EXPECT_EQ(toml_error(fmt::format("x = {{ y = {0}\n{0}, {1} = 1 }}\n", quotes, key)),
              "a.toml:2: a key of too many parts, expected TOML of a table and a key");
  }
}

TEST(InputFile, StringsOfTomlHoldAnyPath) {
  for (const std::string path :
       {"a b", "it's", "say \"so\"", "back\\slash", "both ' and \"", "new\nline", "\u00e9"})
    EXPECT_EQ(parse_toml(fmt::format("x = {}\n", toml_string(path)), "a.toml")["x"].value<std::string>(),
              path);
}

}  // namespace
}  // namespace splatscope
