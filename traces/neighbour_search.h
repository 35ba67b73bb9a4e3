#pragma once

#include <cmath>
#include <cstdint>
#include <nanoflann.hpp>
#include <span>
#include <vector>

#include "model/stop.h"
#include "traces/scene.h"

namespace splatscope::traces {

// Finds the surfels nearest to a surfel, or those about a place. The surfels must outlive it; their positions
// must be finite. Several threads may search at once, each with a `Found` of its own. Throws Interrupted
// where it is asked to stop.
class NeighbourSearch {
 public:
  struct Found {
    std::vector<std::uint32_t> index;      // nearest first
    std::vector<double> squared_distance;  // in double: squares of float coordinates overflow
    std::size_t size() const { return index.size(); }
    double distance(std::size_t i) const { return std::sqrt(squared_distance[i]); }
  };

  explicit NeighbourSearch(std::span<const Surfel> surfels) : positions_{surfels}, tree_(3, positions_) {}

  // The `count` surfels nearest to number i, itself among them; fewer where there are fewer.
  void find(std::size_t i, std::size_t count, Found& found) const {
    found.index.resize(count);
    found.squared_distance.resize(count);
    const glm::vec3& p = positions_.surfels[i].position;
    const float query[] = {p.x, p.y, p.z};
    Nearest nearest(found);
    tree_.findNeighbors(nearest, query, nanoflann::SearchParams());
    found.index.resize(nearest.size());
    found.squared_distance.resize(nearest.size());
  }

  // Calls visit(number) for every surfel that lies no further than `reach` from a place, in any order.
  template <class Visit>
  void within(const glm::vec3& place, double reach, const Visit& visit) const {
    const float query[] = {place.x, place.y, place.z};
    Within<Visit> within{reach * reach, visit};
    tree_.findNeighbors(within, query, nanoflann::SearchParams());
  }

 private:
  // What nanoflann finds; the names are the library's. It ends a search once all that it asks for lie in the
  // very place, where no other is nearer: thousands of surfels in one place would else go through one
  // another.
  class Nearest {
   public:
    explicit Nearest(Found& found) : all_(found.size()) {
      all_.init(found.index.data(), found.squared_distance.data());
    }
    std::size_t size() const { return all_.size(); }
    bool full() const { return all_.full(); }
    double worstDist() const { return all_.worstDist(); }
    bool addPoint(double squared_distance, std::uint32_t surfel) {
      return all_.addPoint(squared_distance, surfel) && worstDist() > 0;
    }

   private:
    nanoflann::KNNResultSet<double, std::uint32_t> all_;
  };

  template <class Visit>
  struct Within {
    double squared_reach;
    const Visit& visit;
    bool full() const { return true; }
    double worstDist() const { return squared_reach; }
    bool addPoint(double squared_distance, std::uint32_t surfel) const {
      if (squared_distance <= squared_reach) visit(surfel);
      return true;
    }
  };

  // nanoflann's view of the surfels; its names are the library's.
  struct Positions {
    std::span<const Surfel> surfels;
    std::size_t kdtree_get_point_count() const { return surfels.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const {
      stop_if_asked();  // the only place of ours in the building of the tree
      return surfels[i].position[static_cast<glm::length_t>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Positions, double>,
                                                   Positions, 3>;
  Positions positions_;
  Tree tree_;
};

}  // namespace splatscope::traces
