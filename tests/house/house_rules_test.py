"""The rules notice breaches: each is shown one, and one case that is in order."""

import sys
import unittest

sys.dont_write_bytecode = True
import house_rules as rules  # noqa: E402  (the script beside this one)


class IncludeDirection(unittest.TestCase):
    def breaches(self, path, included):
        return list(rules.include_breaches(path, f'#include "{included}"\n'))

    def test_against_the_direction(self):
        for path, included in (
            ("scene/a.cpp", "particle/core/body.hpp"),
            ("particle/core/a.cpp", "studies/driver/fits.hpp"),
            ("particle/delaunay/a.cpp", "fem_reference/entry.hpp"),
            ("sph_reference/total_lagrangian/a.cpp", "particle/delaunay/bonds.hpp"),
            ("fem_reference/a.cpp", "particle/core/body.hpp"),
            ("studies/driver/a.cpp", "particle/core/body.hpp"),
            ("scene/a.cpp", "concord/particle/core/body.hpp"),
            ("particle/delaunay/a.cpp", "particle/cbm/bonds.hpp"),
            ("particle/core/a.cpp", "particle/delaunay/bonds.hpp"),
            ("scene/a.cpp", "deal.II/base/point.h"),
            ("studies/driver/a.cpp", "toml++/toml.h"),
        ):
            self.assertEqual(len(self.breaches(path, included)), 1, f"{path} -> {included}")

    def test_along_the_direction(self):
        for path, included in (
            ("particle/delaunay/a.cpp", "particle/core/body.hpp"),
            ("particle/cbm/a.cpp", "particle/delaunay/bonds.hpp"),
            ("sph_reference/total_lagrangian/a.cpp", "particle/core/body.hpp"),
            ("studies/driver/a.cpp", "scene/problem.hpp"),
            ("fem_reference/a.cpp", "deal.II/base/point.h"),
        ):
            self.assertEqual(self.breaches(path, included), [], f"{path} -> {included}")


class Size(unittest.TestCase):
    def test_limit(self):
        self.assertEqual(list(rules.size_breaches("a.cpp", "\n" * 400)), [])
        self.assertEqual(len(list(rules.size_breaches("a.cpp", "\n" * 401))), 1)


class Start(unittest.TestCase):
    def test_heavy_libraries(self):
        light = "\tlibconcord_scene.so.0 => /a/libconcord_scene.so.0 (0x1)\n\tlibc.so.6 => /b/libc.so.6 (0x2)\n"
        self.assertEqual(list(rules.start_breaches(light)), [])
        self.assertEqual(len(list(rules.start_breaches(light + "\tlibgmsh.so.4.8 => /b/libgmsh.so.4.8 (0x3)\n"))), 1)


if __name__ == "__main__":
    unittest.main()
