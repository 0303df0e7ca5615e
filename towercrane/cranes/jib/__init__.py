"""The jib crane, whose rope is carried by a boom on a post. Imports no other family."""
