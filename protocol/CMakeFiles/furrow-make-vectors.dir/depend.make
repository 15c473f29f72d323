# Empty dependencies file for furrow-make-vectors.
# This may be replaced when dependencies are built.
