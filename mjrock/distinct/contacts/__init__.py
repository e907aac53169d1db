"""Contact lines: their faces, the forces along normals and faces, and what happens inside a step."""
