# Empty dependencies file for furrow_protocol.
# This may be replaced when dependencies are built.
