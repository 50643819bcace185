"""Files in and out: meshes, images, volumes.

Every function here returns NumPy arrays and knows nothing of scenes. Whatever is wrong with a file is
raised as :class:`pellucid.errors.AssetError`, which names the file, the reason and what to do.
"""
