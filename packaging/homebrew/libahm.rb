# brew install --HEAD ./packaging/homebrew/libahm.rb, with the address of the repository in
# HOMEBREW_AHM_REPOSITORY. This recipe was not run.
class Libahm < Formula
  desc "Logarithmic maps on meshes, point clouds and grids"
  license "MIT"
  head ENV.fetch("HOMEBREW_AHM_REPOSITORY", "file:///path/to/libahm"), using: :git, branch: "main"

  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "eigen"
  depends_on "nanoflann"

  def install
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", *std_cmake_args,
           *%w[FLANN MINIZIP PCL PUGIXML].map { |name| "-DAHM_WITH_#{name}=OFF" },
           *%w[APPS PYTHON TESTS EXAMPLES].map { |name| "-DAHM_BUILD_#{name}=OFF" }
    system "cmake", "--build", "build", "--target", "install"
  end

  test do
    assert_path_exists include/"ahm/ahm.hpp"
  end
end
