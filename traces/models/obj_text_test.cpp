#include "traces/models/obj_text.h"

#include <gtest/gtest.h>

#include "model/testing/scratch_folder.h"

namespace splatscope::traces {
namespace {

std::string text_of(std::string_view text) {
  const ScratchFolder folder;
  return obj_text(folder.file("m.obj", text));
}

TEST(ObjText, CommentsBehindNumbersAndElementsGo) {
  EXPECT_EQ(text_of("v 0 0 0 # first\nf 1 2 3 # a face\nl 1 2# a line\n"), "v 0 0 0 \nf 1 2 3 \nl 1 2\n");
  EXPECT_EQ(text_of("f 1 2 \\\n3 # a face\nvn 0 0 1#up"), "f 1 2 \\\n3 \nvn 0 0 1");
}

TEST(ObjText, NamesKeepTheirSigns) {
  EXPECT_EQ(text_of("mtllib a #1.mtl\nusemtl skin #2\no part #3\nf 1 2 3\n"), "");  // nothing has to change
}

}  // namespace
}  // namespace splatscope::traces
