#include "studies/reproduction/zwicker_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace splatscope::studies {
namespace {

double mean_opacity(const kernels::LayeredPicture& picture, int left, int top, int size) {
  double sum = 0;
  for (int row = top; row < top + size; ++row) {
    for (int column = left; column < left + size; ++column)
      sum += picture.pixels[static_cast<std::size_t>(row * picture.width + column)].w;
  }
  return sum / (size * size);
}

// Closed surfaces are whole inside, and the glass lets the seats and what is behind it through.
TEST(ZwickerSurfaces, PicturesOfTheStandIns) {
  const SurfaceModel head = head_model(20000, 96);
  EXPECT_EQ(head.surfels.size(), 20000u);
  EXPECT_GT(mean_opacity(draw_layered(head, 4), 38, 38, 20), 0.999);

  const SurfaceModel terrain = terrain_model(40000, 96);
  EXPECT_GT(mean_opacity(draw_layered(terrain, 4), 38, 50, 20), 0.99);
  for (const int points : {40000, 40001, 40399}) {  // 200 x 200 and more
    const SurfaceModel model = terrain_model(points, 96);
    EXPECT_EQ(model.surfels.size(), static_cast<std::size_t>(points));
    for (const kernels::Surfel& surfel : model.surfels)
      ASSERT_LT(std::max(std::abs(surfel.position.x), std::abs(surfel.position.z)), 1);
  }

  const SurfaceModel helicopter = helicopter_model(60000, 96);
  EXPECT_EQ(helicopter.surfels.size(), 60000u);
  EXPECT_EQ(helicopter.opacities.size(), 60000u);
  const kernels::LayeredPicture layers = draw_layered(helicopter, 4), one = draw_layered(helicopter, 1);
  double less = 0;
  for (std::size_t i = 0; i < layers.pixels.size(); ++i) less += layers.pixels[i].w - one.pixels[i].w;
  EXPECT_GT(less, 100);  // pixels' worth of what is seen through the glass
}

TEST(ZwickerSurfaces, TableHasThePapersModelsAtBothSizes) {
  const std::vector<SurfaceRow> rows = surface_rows(0.01, 1);
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].points, 4291u);
  EXPECT_EQ(rows[2].points, 47820u);
  EXPECT_EQ(rows[5].points, 9876u);
  for (const SurfaceRow& row : rows) {
    EXPECT_GT(row.layered_seconds, 0);
    EXPECT_GT(row.single_seconds, 0);
  }
}

}  // namespace
}  // namespace splatscope::studies
