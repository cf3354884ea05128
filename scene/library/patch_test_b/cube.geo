// The cube of patch test A.
Include "../patch_test_a/cube.geo";
