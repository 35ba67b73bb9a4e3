#include "traces/volumes/nrrd_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <random>
#include <string>

#include "model/error.h"
#include "model/testing/append_bytes.h"
#include "model/testing/scratch_folder.h"

namespace splatscope::traces {
namespace {

class NrrdFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    return folder_.file(name, bytes);
  }
  // What is said of a wrong file, without its folder.
  std::string error_of(const std::string& bytes) const {
    return folder_.error_of([&] { read_nrrd(write("a.nrrd", bytes)); });
  }

  ScratchFolder folder_;
};

std::string header(const std::string& type, const std::string& sizes, const std::string& more = "") {
  return "NRRD0004\n# a comment\ntype: " + type + "\ndimension: 3\nsizes: " + sizes +
         "\nencoding: raw\nendian: little\nname:=value\n" + more + "\n";
}

template <class Value>
std::string bytes_of_values(std::initializer_list<Value> values, bool swap = false) {
  std::string bytes;
  for (const Value value : values) append_bytes(bytes, value, swap);
  return bytes;
}

TEST_F(NrrdFile, ReadsEachTypeInEitherOrderOfBytes) {
  const kernels::Volume bytes = read_nrrd(
      write("a.nrrd", header("uchar", "3 1 2", "spacings: 1 0.5 2\n") + std::string("\1\2\3\4\5\377", 6)));
  EXPECT_EQ(bytes.size, glm::ivec3(3, 1, 2));
  EXPECT_EQ(bytes.spacing, glm::dvec3(1, 0.5, 2));
  EXPECT_EQ(bytes.center(), glm::dvec3(0));
  EXPECT_EQ(bytes.values, (std::vector<float>{1, 2, 3, 4, 5, 255}));
  const kernels::Volume shorts =
      read_nrrd(write("b.nrrd", header("short", "2 1 1", "space directions: (0,2,0) (3,0,4) (0.8,0,-0.6)\n") +
                                    bytes_of_values<std::int16_t>({-1024, 3033})));
  EXPECT_EQ(shorts.values, (std::vector<float>{-1024, 3033}));
  EXPECT_EQ(shorts.spacing, glm::dvec3(2, 5, 1));
  const std::string big = "NRRD0001\ntype: float\ndimension: 3\nsizes: 1 2 1\nencoding: raw\nendian: big\n\n";
  EXPECT_EQ(read_nrrd(write("c.nrrd", big + bytes_of_values<float>({0.5f, -2e9f}, true))).values,
            (std::vector<float>{0.5f, -2e9f}));
  EXPECT_EQ(read_nrrd(write("d.nrrd", header("double", "1 1 1") + bytes_of_values<double>({0.25}))).values,
            (std::vector<float>{0.25f}));
}

TEST_F(NrrdFile, ReadsTheEndsOfEachWholeType) {
  on_each_whole_type([&]<class Value>(const std::string& name, const char*, Value least, Value most) {
    for (const bool big : {false, true}) {
      std::string text = header(name, "2 1 1");
      if (big) text.replace(text.find("little"), 6, "big");
      text += bytes_of_values<Value>({least, most}, big);
      EXPECT_EQ(read_nrrd(write("a.nrrd", text)).values,
                (std::vector<float>{static_cast<float>(least), static_cast<float>(most)}))
          << name;
    }
  });
}

TEST_F(NrrdFile, ReadsRawDataBesideAHeader) {
  write("a.raw", "skip\1\2");
  const auto path = write("a.nhdr", header("uint8", "2 1 1", "data file: a.raw\nbyte skip: 4\n"));
  EXPECT_EQ(read_nrrd(path).values, (std::vector<float>{1, 2}));
  EXPECT_EQ(error_of(header("uint8", "2 1 1", "data file: b.raw\n")),
            "b.raw: cannot be read, expected the raw data that the header names");
}

// "Field identifiers are not case sensitive", and some have a spelling without a blank.
TEST_F(NrrdFile, FieldsAreReadInAnySpelling) {
  const auto spacing = [&](const std::string& field) {
    return read_nrrd(write("a.nrrd", header("uint8", "1 1 1", field) + "1")).spacing;
  };
  for (const char* field :
       {"Spacings: 1 2 3\n", "SPACE DIRECTIONS: (1,0,0) (0,2,0) (0,0,3)\n",
        "spacedirections: (1,0,0) (0,2,0) (0,0,3)\n", "spacings: 1 2 3\naxis mins: 0 0 0\n"})
    EXPECT_EQ(spacing(field), glm::dvec3(1, 2, 3)) << field;
  write("a.raw", "skip\7");
  EXPECT_EQ(read_nrrd(write("a.nhdr", header("uint8", "1 1 1", "Data File: a.raw\nBYTE SKIP: 4\n"))).values,
            std::vector<float>{7});
  EXPECT_EQ(error_of(header("uint8", "1 1 1", "Axis Maxs: 1 1 1\n")),
            "a.nrrd:10: axis mins or maxs without spacings, expected spacings");
  EXPECT_EQ(error_of(header("uint8", "1 1 1", "data file: a.raw\ndatafile: a.raw\n")),
            "a.nrrd:10: \"datafile\" for the second time, expected it once, as in line 9");
}

// As other readers of the format take them.
TEST_F(NrrdFile, WordsAreReadInLargeLetters) {
  const std::string header =
      "NRRD0004\r\ntype: UINT16\r\ndimension: 3\r\nsizes: 1 1 1\r\nencoding: RAW\r\nendian: Big\r\n\r\n";
  EXPECT_EQ(read_nrrd(write("a.nrrd", header + std::string("\1\2", 2))).values, std::vector<float>{258});
}

TEST_F(NrrdFile, NamesTheLineOfWhatIsWrong) {
  EXPECT_EQ(error_of("PLY\n"), "a.nrrd:1: the first line is not \"NRRD000N\", expected a NRRD file");
  EXPECT_EQ(error_of("NRRD0004x\n"), "a.nrrd:1: the first line is not \"NRRD000N\", expected a NRRD file");
  EXPECT_EQ(error_of(""), "a.nrrd:1: the first line is not \"NRRD000N\", expected a NRRD file");
  EXPECT_EQ(
      error_of(header("block", "1 1 1")),
      "a.nrrd:3: type is \"block\", expected int8, uint8, int16, uint16, int32, uint32, float or double");
  EXPECT_EQ(error_of(header("int8|uint8", "1 1 1")).substr(0, 12), "a.nrrd:3: ty");
  EXPECT_EQ(error_of(header("uint8", "1 1")), "a.nrrd:5: 2 sizes, expected three");
  EXPECT_EQ(error_of(header("uint8", "1 0 1")),
            "a.nrrd:5: a size of \"0\", expected a whole number from 1 to 32768");
  EXPECT_EQ(error_of(header("uint8", "1 99999999999999999999 1")),
            "a.nrrd:5: a size of \"99999999999999999999\", expected a whole number from 1 to 32768");
  EXPECT_EQ(error_of(header("uint8", "32768 32768 32768")),
            "a.nrrd:5: 35184372088832 voxels, expected at most 536870912");
  EXPECT_EQ(error_of(header("uint8", "1 1 1", "spacings: 1 nan 1\n")),
            "a.nrrd:9: a spacing of \"nan\", expected a number from 1e-9 to 1e9");
  EXPECT_EQ(error_of(header("uint8", "1 1 1", "spacings: -1 1 1\n")),
            "a.nrrd:9: a spacing of \"-1\", expected a number from 1e-9 to 1e9");
  EXPECT_EQ(error_of(header("uint8", "1 1 1", "byte skip: -1\n")),
            "a.nrrd:9: byte skip is \"-1\", expected a whole number from 0 to 4294967295");
  EXPECT_EQ(error_of(header("uint8", "1 1 1", "line skip: 1\n")), "a.nrrd:9: line skip is \"1\", expected 0");
  EXPECT_EQ(error_of("NRRD0004\nendian: middle\n"), "a.nrrd:2: endian is \"middle\", expected big or little");
  EXPECT_EQ(error_of(header("uint8", "1 1 1", "data file: LIST\n")),
            "a.nrrd:9: data file is \"LIST\", expected the name of one file");
  EXPECT_EQ(error_of(header("uint8", "1 1 1", "sizes: 1 1 1\n")),
            "a.nrrd:9: \"sizes\" for the second time, expected it once, as in line 5");
  EXPECT_EQ(error_of(header("uint8", "1 1 1", "space directions: (1,0,0) (0.8,0.6,0) (0,0,1)\n")),
            "a.nrrd:9: skewed space directions, expected axes at right angles");
  EXPECT_EQ(
      error_of(header("uint8", "1 1 1", "spacings: 1 1 1\nspace directions: (2,0,0) (0,1,0) (0,0,1)\n")),
      "a.nrrd:11: spacings beside space directions, expected one of them");
  EXPECT_EQ(error_of("NRRD0004\n  \n"),
            "a.nrrd:2: a line of blanks, expected an empty line at the end of the header");
  EXPECT_EQ(error_of("NRRD0004\ntype: uint8\nencoding: gzip\n"),
            "a.nrrd:3: encoding is \"gzip\", expected raw (unu save -e raw converts)");
  EXPECT_EQ(error_of("NRRD0004\ntype: uint8\n\n"),
            "a.nrrd:3: the header ends without \"dimension\", expected that field");
  EXPECT_EQ(error_of("NRRD0004\n" + std::string(2000, 'x')),
            "a.nrrd:2: a line of more than 1024 characters, expected a NRRD header");
  EXPECT_EQ(error_of("NRRD0004\ntype: short\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n\nab"),
            "a.nrrd:6: the header ends without \"endian\", expected big or little for this type");
}

TEST_F(NrrdFile, RefusesTooFewDataBeforeItMakesRoomForThem) {
  EXPECT_EQ(error_of(header("double", "32768 16384 1") + "few"),
            "a.nrrd: 3 bytes of data, expected 4294967296 for 32768 x 16384 x 1 voxels of 8 bytes");
  EXPECT_EQ(error_of(header("uint8", "2 1 1", "byte skip: 4294967295\n") + "ab"),
            "a.nrrd: 0 bytes of data, expected 2 for 2 x 1 x 1 voxels of 1 bytes");
}

TEST_F(NrrdFile, NamesTheVoxelThatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_of(header("float", "2 2 2") + bytes_of_values<float>({0, 1, 2, 3, 4, 5, nan, 7})),
            "a.nrrd: voxel (0, 1, 1) is nan, expected finite values in single precision");
  EXPECT_EQ(error_of(header("double", "1 1 1") + bytes_of_values<double>({1e300})),
            "a.nrrd: voxel (0, 0, 0) is inf, expected finite values in single precision");
}

TEST_F(NrrdFile, ReadsPlacesOfVoxels) {
  const auto vectors = [](const std::string& dimension, const std::string& sizes) {
    return "NRRD0004\ntype: float\ndimension: " + dimension + "\nsizes: " + sizes +
           "\nencoding: raw\nendian: little\nspacings: nan 1 1 1\n\n";
  };
  const auto refused = [&](const std::string& bytes) {
    return folder_.error_of([&] { read_nrrd_positions(write("a.nrrd", bytes)); });
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const VoxelPositions positions = read_nrrd_positions(
      write("a.nrrd", vectors("4", "3 1 2 1") + bytes_of_values<float>({1, 2, 3, 4, 5, 6})));
  EXPECT_EQ(positions.size, glm::ivec3(1, 2, 1));
  EXPECT_EQ(positions.at({0, 0, 0}), glm::dvec3(1, 2, 3));
  EXPECT_EQ(positions.at({0, 1, 0}), glm::dvec3(4, 5, 6));
  EXPECT_EQ(refused(vectors("3", "1 2 1")), "a.nrrd:3: dimension is \"3\", expected 4");
  EXPECT_EQ(refused(vectors("4", "1 2 1 3")), "a.nrrd:4: sizes are \"1 2 1 3\", expected 3 and three more");
  EXPECT_EQ(refused(vectors("4", "3 1 1 1") + "abc"),
            "a.nrrd: 3 bytes of data, expected 12 for 1 x 1 x 1 voxels of 12 bytes");
  EXPECT_EQ(refused(vectors("4", "3 1 2 1") + bytes_of_values<float>({1, 2, 3, 4, nan, 6})),
            "a.nrrd: voxel (0, 1, 0) is nan, expected finite values in single precision");
}

// Bytes changed at random: an error or a volume, and nothing else.
TEST_F(NrrdFile, DamagedHeadersAreReadOrRefused) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  const std::string good =
      header("float", "2 2 2", "spacings: 1 1 2\nbyte skip: 3\n") + "abc" + std::string(32, '\0');
  int read = 0, refused = 0;
  for (int i = 0; i < 500; ++i) {
    std::string bytes = good;
    for (int changes = 0; changes < 3; ++changes) {
      bytes[random() % bytes.size()] = static_cast<char>(random() % 2 ? random() % 256 : '0' + random() % 12);
    }
    if (random() % 4 == 0) bytes.resize(random() % bytes.size());
    try {
      read_nrrd(write("a.nrrd", bytes));
      ++read;
    } catch (const UserError&) {
      ++refused;
    }
  }
  EXPECT_GT(read, 25);
  EXPECT_GT(refused, 25);
}

}  // namespace
}  // namespace splatscope::traces
