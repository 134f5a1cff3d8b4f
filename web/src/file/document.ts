// What `kith lesson` puts into a lesson file.
export interface LessonFile {
  schema: 'kith.lesson/1';
  kith: string;
  title: string;
  digest: string; // of the inputs
  inputs: Record<string, string>; // study, domain, and what they name
  setup: Record<string, unknown>; // of the room
}

export function readDocument(): LessonFile {
  return JSON.parse(document.getElementById('kith-document')?.textContent ?? '') as LessonFile;
}
