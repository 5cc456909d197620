"""What acts on beams, one file each: supports, joints, loads, masses, springs, links, drag."""
