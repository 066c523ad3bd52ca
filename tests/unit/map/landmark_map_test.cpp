#include <cmath>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include <libslam/map/landmark_map.hpp>

namespace libslam {
namespace {

LandmarkEstimate make_landmark(std::int64_t id, Eigen::Index dimension, std::mt19937& generator,
                               const std::string& type = "point") {
  std::normal_distribution<double> normal;
  LandmarkEstimate landmark;
  landmark.id = id;
  landmark.type = type;
  landmark.mean = Eigen::VectorXd::NullaryExpr(dimension, [&] { return normal(generator); });
  const Eigen::MatrixXd A =
      Eigen::MatrixXd::NullaryExpr(dimension, dimension, [&] { return normal(generator); });
  landmark.cov = A * A.transpose();
  landmark.cov = landmark.cov.selfadjointView<Eigen::Upper>();
  landmark.times_seen = static_cast<int>(std::abs(id) % 100);
  return landmark;
}

std::string text_of(const LandmarkMap& map) {
  std::ostringstream out;
  write_landmark_map(out, map);
  return out.str();
}

LandmarkMap read(const std::string& text) {
  std::istringstream in(text);
  return read_landmark_map(in, "map.csv");
}

TEST(LandmarkMap, ExtentsOfLinesAreColumnsOfTheirOwn) {
  std::mt19937 generator(2);
  LandmarkMap map;
  map.add(make_landmark(4, 2, generator));
  EXPECT_EQ(text_of(map).find("begin"), std::string::npos);  // points alone: as ever
  LandmarkEstimate line = make_landmark(5, 2, generator, "line");
  line.extent = Extent{-1.0 / 3.0, 2.5, 0.01, 1e-300};
  map.add(line);
  const std::string text = text_of(map);
  EXPECT_NE(text.find(",times_seen,begin,end,sigma_begin,sigma_end\n"), std::string::npos);
  const LandmarkMap back = read(text);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_FALSE(back.landmarks()[0].extent);
  ASSERT_TRUE(back.landmarks()[1].extent);
  EXPECT_EQ(back.landmarks()[1].extent->begin, line.extent->begin);
  EXPECT_EQ(back.landmarks()[1].extent->end, line.extent->end);
  EXPECT_EQ(back.landmarks()[1].extent->sigma_begin, line.extent->sigma_begin);
  EXPECT_EQ(back.landmarks()[1].extent->sigma_end, line.extent->sigma_end);
  EXPECT_EQ(text_of(back), text);
}

TEST(LandmarkMap, RefusesAnExtentThatEndsBeforeItBegins) {
  const std::string head =
      "id,type,mean_1,mean_2,cov_11,cov_12,cov_22,times_seen,begin,end,sigma_begin,sigma_end\n";
  EXPECT_NO_THROW(read(head + "1,line,0,2,1,0,1,3,1,2,0.1,0.1\n"));
  EXPECT_THROW(read(head + "1,line,0,2,1,0,1,3,2,1,0.1,0.1\n"), std::runtime_error);
  EXPECT_THROW(read(head + "1,line,0,2,1,0,1,3\n"), std::runtime_error);
}

TEST(LandmarkMap, ReadsBackBitForBitAlsoWithMixedDimensions) {
  std::mt19937 generator(1);
  LandmarkMap map;
  map.add(make_landmark(4, 2, generator));
  map.add(make_landmark(-7, 3, generator));
  map.add(make_landmark(9000000000, 2, generator, "line"));
  const LandmarkMap back = read(text_of(map));
  ASSERT_EQ(back.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const LandmarkEstimate &a = map.landmarks()[i], &b = back.landmarks()[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(a.mean, b.mean);
    EXPECT_EQ(a.cov, b.cov);
    EXPECT_EQ(a.times_seen, b.times_seen);
  }
  EXPECT_EQ(text_of(back), text_of(map));
}

TEST(LandmarkMap, TextIsTheDocumentedOne) {
  LandmarkMap map;
  map.add({5, "point", Eigen::Vector2d(1.5, -2), Eigen::Vector2d(0.25, 4).asDiagonal(), 8});
  EXPECT_EQ(text_of(map),
            "id,type,x,y,cov_xx,cov_xy,cov_yy,times_seen\n5,point,1.5,-2,0.25,0,4,8\n");
}

TEST(LandmarkMap, EmptyMapIsAHeader) {
  EXPECT_TRUE(read(text_of({})).empty());
}

TEST(LandmarkMap, RefusesWhatCannotBeALandmark) {
  std::mt19937 generator(2);
  LandmarkMap map;
  map.add(make_landmark(1, 2, generator));
  EXPECT_THROW(map.add(make_landmark(1, 2, generator)), std::invalid_argument);
  LandmarkEstimate landmark = make_landmark(2, 2, generator);
  landmark.mean(0) = std::nan("");
  EXPECT_THROW(map.add(landmark), std::invalid_argument);
  landmark = make_landmark(2, 2, generator);
  landmark.cov = Eigen::Matrix3d::Identity();
  EXPECT_THROW(map.add(landmark), std::invalid_argument);
  EXPECT_THROW(map.add(make_landmark(2, 2, generator, "a,b")), std::invalid_argument);
  EXPECT_EQ(map.size(), 1u);
  EXPECT_EQ(map.find(1), &map.landmarks()[0]);
  EXPECT_EQ(map.find(2), nullptr);
}

TEST(LandmarkMap, MalformedTextNamesTheLine) {
  const std::string header = "id,type,x,y,cov_xx,cov_xy,cov_yy,times_seen\n";
  const std::string good = "1,point,0,0,1,0,1,1\n";
  for (const std::string& bad :
       {header + good + "2,point,0,0,1,0,1\n", header + good + "2,point,nan,0,1,0,1,1\n",
        header + good + good, header + good + "2,point,,,,,,1\n",
        header + good + "2,point,0,0,,,,1\n"}) {
    try {
      read(bad);
      FAIL() << bad;
    } catch (const std::runtime_error& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("map.csv:3: ")) << error.what();
    }
  }
  EXPECT_THROW(read(""), std::runtime_error);
  EXPECT_THROW(read("hello\n"), std::runtime_error);
  EXPECT_THROW(read_landmark_map(std::filesystem::path("/nonexistent/map.csv")),
               std::runtime_error);
}

}  // namespace
}  // namespace libslam
