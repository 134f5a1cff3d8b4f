// What `kith lesson` puts into a lesson file.
export interface LessonFile {
  schema: 'kith.lesson/1' | 'kith.report/1';
  kith: string;
  title: string;
  digest: string; // of the inputs
  inputs: Record<string, string>; // study, domain, and what they name
  setup: Record<string, unknown>; // of the room
  origins: string[]; // of pages around this one that are told how it goes
  alone?: true; // a domain without a study
  package?: true; // made for a learning system
  playground?: true; // the domain can be changed
}

export function readDocument(): LessonFile {
  return JSON.parse(document.getElementById('kith-document')?.textContent ?? '') as LessonFile;
}
