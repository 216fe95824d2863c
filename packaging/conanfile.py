"""Conan 2: conan create packaging, in the repository."""

import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, CMakeDeps, cmake_layout
from conan.tools.files import copy, load


class Ahm(ConanFile):
    name = "libahm"
    license = "MIT"
    description = "Logarithmic maps on meshes, point clouds and grids"
    settings = "os", "compiler", "build_type", "arch"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": False, "fPIC": True}
    requires = "eigen/3.4.0", "nanoflann/1.5.2"

    def set_version(self):
        header = load(self, os.path.join(self.recipe_folder, "../libahm/core/include/ahm/version.hpp"))
        words = [line.split()[2] for line in header.splitlines() if line.startswith("#define AHM_VERSION_")]
        self.version = ".".join(words)

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "README.md", "CHANGELOG.md", "cmake/*", "packaging/*", "libahm/*", "backends/*"):
            copy(self, pattern, os.path.join(self.recipe_folder, ".."), self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for option in ("WITH_FLANN", "WITH_PCL", "BUILD_APPS", "BUILD_PYTHON", "BUILD_TESTS", "BUILD_EXAMPLES"):
            toolchain.cache_variables["AHM_" + option] = False
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        self.cpp_info.builddirs = ["lib/cmake/ahm"]  # the package's own ahm-config.cmake serves find_package(ahm)
        self.cpp_info.set_property("cmake_find_mode", "none")
